"""The page, the tables and the curves of a comparison."""
import html
import math
import urllib.parse

import svg_plot
from measures import METRICS
from tables import all_tables, codecs_of, mean

UNITS = {"psnr": "RGB PSNR [dB]", "luma_psnr": "luma PSNR [dB]", "ssim": "SSIM", "ciede2000": "CIEDE2000"}
STYLE = ("body{font:14px sans-serif;margin:2em auto;max-width:1700px;padding:0 1em}table{border-collapse:collapse;margin:1em 0}"
         "td,th{border:1px solid #ccc;padding:3px 8px;text-align:right;vertical-align:top}figure{display:inline-block;margin:4px}"
         "figure img{width:384px;display:block}")


SHOWN_BYTES = (2000, 4000, 8000, 16000)


def drawn_file(out, group, name, limit=None, codec=None):
    """Where the picture lies as a codec draws it from a file of at most so many bytes, or the original."""
    return out / "pictures" / group / (f"{name}-{limit}-{codec}.png" if codec else f"{name}.png")


def markdown_table(table):
    title, note, head, rows = table
    lines = [f"## {title}", "", note, ""] if note else [f"## {title}", ""]
    for row in (head, ["---"] * len(head), *rows):
        lines.append("| " + " | ".join(map(str, row)) + " |")
    return "\n".join(lines)


def html_table(table):
    title, note, head, rows = table

    def line(tag, row):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(c).strip('`'))}</{tag}>" for c in row) + "</tr>"
    return (f"<h2>{html.escape(title)}</h2><p>{html.escape(note)}</p><table>{line('th', head)}"
            f"{''.join(line('td', row) for row in rows)}</table>")


def curve_files(pictures, limits):
    """{file name: SVG} of means over the pictures."""
    plots = {}
    for full_size in (False, True):
        for metric in METRICS if not full_size else ("psnr",):
            series = {}
            for codec in codecs_of(pictures):
                means = [(n / 1000, mean(pictures, codec, str(n), metric, full_size)) for n in limits]
                series[codec] = [(x, y) for x, y in means if y is not None]
            series = {codec: points for codec, points in series.items() if points}
            name = metric.replace("_", "-") + ("-full-size" if full_size else "")
            title = f"{METRICS[metric]}, " + ("all at full size" if full_size else "best of full and reduced sizes")
            # The axis ends a little below the least, for PSNR starts nowhere near 0.
            least = min(y for points in series.values() for _, y in points)
            floor = 2 * math.floor(least / 2) if "psnr" in metric else 0.1 * math.floor(10 * least) if metric == "ssim" else 0
            plots[f"compression-{name}.svg"] = svg_plot.curves(title, "kB", UNITS[metric], series, floor)
    return plots


def gallery(out, group, names, codecs):
    """The pictures that were drawn: each original, then a line for each number of bytes."""
    def figure(file, label):
        source = urllib.parse.quote(file.relative_to(out).as_posix())
        return f'<figure><a href="{source}"><img src="{source}" alt=""></a><figcaption>{label}</figcaption></figure>'

    body = []
    for name in names:
        body.append(figure(drawn_file(out, group, name), html.escape(name)))
        for limit in SHOWN_BYTES:
            files = {codec: drawn_file(out, group, name, limit, codec) for codec in codecs}
            body += ["<br>", *(figure(file, f"{codec}, {limit} bytes") for codec, file in files.items() if file.exists())]
        body.append("<hr>")
    return "".join(body)


def write(figures, limits, shown, out):
    """compression.md, compression.html and the curves."""
    tables = all_tables(figures)
    (out / "compression.md").write_text("\n\n".join(map(markdown_table, tables)) + "\n", "utf-8")
    groups = figures["groups"]
    plots = curve_files(groups["photographs"], limits) if "photographs" in groups and len(limits) > 1 else {}
    for name, svg in plots.items():
        (out / name).write_text(svg + "\n", "utf-8")
    pictures = "".join(f"<h2>{title} at equal bytes</h2>" + gallery(out, group, names or groups[group], codecs_of(groups[group]))
                       for title, group, names in (("Photographs", "photographs", shown), ("Drawings", "drawings", None),
                                                   ("Smooth pictures", "smooth", None)) if group in groups)
    page = (f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Coded meshes</title><style>{STYLE}</style>'
            "<h1>Coded meshes beside other formats</h1><p>Every file is the largest that its encoder makes within the bytes. "
            "Whole files count, headers included. Other formats may code a smaller picture, scaled up again by the better of "
            "Lanczos and bicubic; a mesh has no size.</p>" + "".join(plots.values()) +
            "".join(map(html_table, tables)) + pictures + "</html>\n")
    (out / "compression.html").write_text(page, "utf-8")
