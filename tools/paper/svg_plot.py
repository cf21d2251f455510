"""Plots as SVG text: curves over a logarithmic axis, and histograms side by side."""
import html
import math

COLORS = ("#3465c9", "#cc3d3d", "#2d9a4b", "#8d55b8", "#d98a1c", "#555555", "#20a5a5", "#b0b030", "#e07bb0", "#7a4a20", "#9fc131",
          "#999999")
WIDTH, HEIGHT = 460, 300
LEFT, RIGHT, TOP, BOTTOM = 52, 12, 28, 44
LEGEND = 250  # beside curves, which are too many to leave room among them


def _frame(title, x_label, y_label, body, width=WIDTH):
    middle_x, middle_y = (LEFT + WIDTH - RIGHT) / 2, (TOP + HEIGHT - BOTTOM) / 2
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {HEIGHT}" width="{width}" '
            f'height="{HEIGHT}" font-family="sans-serif" font-size="11">'
            f'<rect width="{width}" height="{HEIGHT}" fill="white"/>'
            f'<text x="{middle_x}" y="16" text-anchor="middle" font-weight="bold">{html.escape(title)}</text>'
            f'<text x="{middle_x}" y="{HEIGHT - 8}" text-anchor="middle">{html.escape(x_label)}</text>'
            f'<text x="14" y="{middle_y}" text-anchor="middle" transform="rotate(-90 14 {middle_y})">'
            f'{html.escape(y_label)}</text>{"".join(body)}</svg>')


def _round_step(span, count):
    raw = span / count
    power = 10 ** math.floor(math.log10(raw))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= raw)


def _y_axis(top_value, floor=0):
    """Scale from `floor` to a round number, and the lines and labels of the axis."""
    step = _round_step(top_value - floor, 5)
    count = math.ceil((top_value - floor) / step)
    to_y = lambda value: HEIGHT - BOTTOM - (value - floor) / (count * step) * (HEIGHT - TOP - BOTTOM)
    body = []
    for k in range(count + 1):
        y = to_y(floor + k * step)
        body.append(f'<line x1="{LEFT}" y1="{y:.1f}" x2="{WIDTH - RIGHT}" y2="{y:.1f}" stroke="#ddd"/>'
                    f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{floor + k * step:g}</text>')
    return to_y, body


def _legend(names, left=WIDTH - RIGHT - 172):
    body = []
    for k, name in enumerate(names):
        y = TOP + 12 + 15 * k
        body.append(f'<rect x="{left}" y="{y - 8}" width="12" height="8" fill="{COLORS[k]}"/>'
                    f'<text x="{left + 18}" y="{y}">{html.escape(name)}</text>')
    return body


def curves(title, x_label, y_label, series, floor=0):
    """series: {name: [(x, y), ...]}, x > 0 on a logarithmic axis, y >= floor."""
    xs = sorted({x for points in series.values() for x, _ in points})
    low, high = math.log(xs[0]), math.log(xs[-1])
    to_x = lambda x: LEFT + (math.log(x) - low) / (high - low) * (WIDTH - LEFT - RIGHT - 10) + 5
    to_y, body = _y_axis(max(y for points in series.values() for _, y in points), floor)
    for x in xs:
        body.append(f'<text x="{to_x(x):.1f}" y="{HEIGHT - BOTTOM + 15}" text-anchor="middle">{x:g}</text>')
    for color, points in zip(COLORS, series.values()):
        line = " ".join(f"{to_x(x):.1f},{to_y(y):.1f}" for x, y in points)
        body.append(f'<polyline points="{line}" fill="none" stroke="{color}" stroke-width="1.8"/>')
        body += [f'<circle cx="{to_x(x):.1f}" cy="{to_y(y):.1f}" r="2.5" fill="{color}"/>' for x, y in points]
    return _frame(title, x_label, y_label, body + _legend(series, WIDTH + 4), WIDTH + LEGEND)


def histograms(title, x_label, series):
    """series: {name: a histogram as imgmesh-compare reports it}, all of one range; drawn as percentages."""
    first = next(iter(series.values()))
    low, high, bins = first["low"], first["high"], len(first["counts"])
    shares = {}
    for name, h in series.items():
        total = sum(h["counts"]) + h["below"] + h["above"]
        # What lies beyond the range goes to the bins at its ends, so that nothing is left out.
        counts = list(h["counts"])
        counts[0] += h["below"]
        counts[-1] += h["above"]
        shares[name] = [100 * c / total for c in counts]
    to_y, body = _y_axis(max(max(s) for s in shares.values()))
    cell = (WIDTH - LEFT - RIGHT) / bins
    bar = 0.84 * cell / len(series)
    for k, (color, share) in enumerate(zip(COLORS, shares.values())):
        for b, value in enumerate(share):
            x, y = LEFT + b * cell + 0.08 * cell + k * bar, to_y(value)
            body.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{bar:.1f}" height="{HEIGHT - BOTTOM - y:.1f}" '
                        f'fill="{color}"/>')
    for k in range(6):
        value = low + (high - low) * k / 5
        x = LEFT + (WIDTH - LEFT - RIGHT) * k / 5
        body.append(f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 15}" text-anchor="middle">{value:g}</text>')
    return _frame(title, x_label, "% of all", body + _legend(series))
