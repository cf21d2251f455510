"""The figures of a bench as text."""


def seconds(row):
    """Of processor time."""
    return row["user_seconds"] + row["system_seconds"]


def text_table(head, rows):
    """Columns of equal width, the first to the left, the others to the right."""
    lines = [head, *rows]
    widths = [max(len(line[c]) for line in lines) for c in range(len(head))]
    return "\n".join("  ".join(cell.ljust(w) if c == 0 else cell.rjust(w) for c, (cell, w) in enumerate(zip(line, widths)))
                     .rstrip() for line in lines)


def number(row, key, digits):
    return f"{row[key]:.{digits}f}" if key in row else ""


def line(row):
    megapixels = row["side"] ** 2 / 1e6
    return [f"{row['kind']} {row['subject']}", f"{seconds(row):.3f}", f"{seconds(row) / megapixels:.3f}",
            number(row, "wall_seconds", 3), f"{row['peak_mib']:.0f}",
            f"{row['peak_mib'] * 2 ** 20 / row['side'] ** 2:.0f}",
            f"{row.get('vertices', '')}", number(row, "rms", 3), number(row, "gouraud_rms", 3), number(row, "refitted_rms", 3)]


HEAD = ["", "CPU s", "s / MP", "wall s", "MiB", "B / px", "vertices", "RMS", "Gouraud", "refitted"]
RATIO_HEAD = ["ours / theirs", "CPU", "least", "most", "wall", "memory", "RMS", "bytes"]
RATIOS = ("time_ratio", "least_time_ratio", "most_time_ratio", "wall_ratio", "memory_ratio", "rms_ratio", "bytes_ratio")


def case_of(row):
    return row["side"], row["density"], row["threads"], row["preset"]


def case_title(case):
    side, density, threads, preset = case
    return f"{side} x {side} pixels, {density:g} % vertices, {threads} thread{'s' if threads > 1 else ''}, preset {preset}"


def tables(report):
    """One table a case, and the ratios against another build where there are some."""
    parts = []
    for case in dict.fromkeys(case_of(row) for row in report["rows"]):
        rows = [row for row in report["rows"] if case_of(row) == case]
        parts.append(case_title(case) + "\n" + text_table(HEAD, [line(row) for row in rows]))
        against = [[row["subject"], *(number(row["against"], key, 3) for key in RATIOS)]
                   for row in rows if "against" in row]
        if against:
            parts.append(text_table(RATIO_HEAD, against))
    return "\n\n".join(parts)


def key_of(row):
    return case_of(row) + (row["kind"], row["subject"])


def comparison(a, b):
    """The ratios b / a of the rows that both have."""
    before = {key_of(row): row for row in a["rows"]}
    lines = []
    for row in b["rows"]:
        old = before.get(key_of(row))
        if old is None:
            continue

        def ratio(key, new=row, past=old):
            return f"{new[key] / past[key]:.3f}" if past.get(key) and key in new else ""
        time = f"{seconds(row) / seconds(old):.3f}" if seconds(old) > 0 else ""
        lines.append([f"{row['side']}, {row['density']:g} %, {row['threads']} thr., {row['preset']}: {row['subject']}", time,
                      ratio("wall_seconds"), ratio("peak_mib"), ratio("rms"), ratio("gouraud_rms"), ratio("bytes")])
    return text_table(["second / first", "CPU", "wall", "memory", "RMS", "Gouraud", "bytes"], lines)
