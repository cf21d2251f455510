"""The tables of a comparison: (title, note, head, rows of text)."""
import statistics

from measures import METRICS, bd_rate
from peers import AVIF_PAYLOAD, PEERS
from points import MESHES, chosen

MESH = "mesh"  # the one that is compared with each of the others
LOW = 8000  # "at few bytes" of the rate differences
COMPARED = (2000, 4000, 8000, 16000)
FORMS = {"psnr": ".2f", "luma_psnr": ".2f", "ssim": ".3f", "ciede2000": ".2f"}


def codecs_of(pictures):
    """In the order of columns."""
    present = next(iter(pictures.values()))
    return [name for name in (*MESHES, *PEERS, AVIF_PAYLOAD.name) if name in present]


def value(points, metric, full_size=False):
    point = chosen(points, metric, full_size)
    return point[metric] if point else None


def mean(pictures, codec, limit, metric, full_size=False):
    """Over all pictures; None where a codec has no file that small for one of them."""
    values = [value(by_codec[codec][limit], metric, full_size) for by_codec in pictures.values()]
    return None if None in values else statistics.fmean(values)


def text(number, form):
    return "" if number is None else format(number, form)


def means_table(title, note, pictures, full_size=False):
    codecs, rows = codecs_of(pictures), []
    for limit in next(iter(pictures.values()))[codecs[0]]:
        means = [[mean(pictures, c, limit, m, full_size) for m in METRICS] for c in codecs]
        rows.append([limit] + ["" if None in figures else " / ".join(format(v, f) for v, f in zip(figures, FORMS.values()))
                               for figures in means])
    return title, note, ["bytes", *codecs], rows


def rate_table(pictures):
    def cell(peer, metric, most):
        sign = -1 if metric == "ciede2000" else 1  # the less the better
        pairs = []
        for by_codec in pictures.values():
            best = [[chosen(points, metric) for limit, points in by_codec[codec].items() if int(limit) <= most]
                    for codec in (MESH, peer)]
            pairs.append([[(p["bytes"], sign * p[metric]) for p in points if p] for points in best])
        return text(bd_rate(pairs), "+.1f")

    rows = [[peer, *(cell(peer, metric, most) for most in (1 << 30, LOW) for metric in METRICS)]
            for peer in codecs_of(pictures) if peer in PEERS]
    return ("Bytes of the mesh against those of others at equal quality, in percent",
            "Mean difference of the rate (BD-rate) over the qualities that both reach, negative where the mesh is smaller.",
            ["against", *METRICS.values(), *(f"{name}, up to {LOW} bytes" for name in METRICS.values())], rows)


def lead_table(pictures):
    limits = [str(n) for n in COMPARED if str(n) in next(iter(pictures.values()))[MESH]]
    rows = []
    for name, by_codec in pictures.items():
        row = [name]
        for peer in [p for p in PEERS if p in by_codec]:
            for limit in limits:
                ours, theirs = (value(by_codec[c][limit], "psnr") for c in (MESH, peer))
                row.append("" if None in (ours, theirs) else format(ours - theirs, "+.2f"))
        rows.append(row)
    head = ["picture", *(f"{peer}, {limit}" for peer in PEERS if peer in codecs_of(pictures) for limit in limits)]
    return "Where the mesh wins and where it loses", "RGB PSNR of the mesh minus that of the other format [dB].", head, rows


def picture_table(title, note, pictures, lossless):
    codecs = codecs_of(pictures)
    rows = [[name, limit, *(text(value(by_codec[c][limit], "psnr"), ".2f") for c in codecs), *lossless[name].values()]
            for name, by_codec in pictures.items() for limit in by_codec[codecs[0]]]
    exact = [f"{codec} without loss, bytes" for codec in next(iter(lossless.values()))]
    return title, note, ["picture", "bytes", *codecs, *exact], rows


def codec_table(figures):
    rows = []
    for name, (size, payload) in figures["empty_bytes"].items():
        peer = PEERS[name]
        rows.append([name, f"{peer.package} {figures['versions'][peer.package]}", f"`{peer.encode}`",
                     f"{size} ({size - payload} without the picture)" if payload else size])
    return ("Other formats", "Bytes of a grey picture of 16 x 16 pixels at the lowest quality are what headers take.",
            ["format", "package", "command", "grey picture, bytes"], rows)


def time_table(pictures):
    rows = []
    for limit in next(iter(pictures.values()))[MESH]:
        points = [by_codec[MESH][limit][0] for by_codec in pictures.values()]
        seconds = [[p[key] for p in points] for key in ("encode_seconds", "decode_seconds")]
        rows.append([limit, *(format(f(s), ".3f") for s in seconds for f in (statistics.fmean, max))])
    return ("CPU seconds of the mesh", "Of the whole programs, reading and writing PNG included.",
            ["bytes", "imgmesh-encode, mean", "most", "imgmesh-decode, mean", "most"], rows)


def photograph_tables(pictures, figures_note):
    tables = [means_table("Photographs", f"{figures_note}: means over {len(pictures)} pictures, other formats at the best of "
                          "full and reduced sizes for each figure. Empty: some picture has no file that small.", pictures),
              means_table("Photographs, all formats at full size", f"{figures_note}: means.", pictures, full_size=True)]
    if MESH in codecs_of(pictures):
        if any(codec in PEERS for codec in codecs_of(pictures)):
            tables += [rate_table(pictures), lead_table(pictures)]
        tables.append(time_table(pictures))
    return tables


def all_tables(figures):
    groups, lossless, tables = figures["groups"], figures["lossless_bytes"], []
    figures_note = " / ".join(METRICS.values())
    if "photographs" in groups:
        tables += photograph_tables(groups["photographs"], figures_note)
    if "thumbnails" in groups:
        tables.append(means_table("Thumbnails", f"{figures_note}: means over pictures of 144 pixels along the longer side, area "
                                  "averages of the photographs. The payload of AVIF does not count its header.",
                                  groups["thumbnails"]))
    for group, title, note in (("drawings", "Drawings", "RGB PSNR [dB]; 100 means equal."),
                               ("smooth", "Smooth pictures", "RGB PSNR [dB].")):
        if group in groups:
            tables.append(picture_table(title, note, groups[group], lossless))
    return tables + [codec_table(figures)] * bool(figures["empty_bytes"])
