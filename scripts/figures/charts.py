# SPDX-License-Identifier: Apache-2.0
"""Charts as SVG: bars and lines on logarithmic or linear axes."""
import math

COLOURS = ("#1f6fb4", "#c2452d", "#2a9d54", "#8a4fb0", "#d18b17")
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" style="font-family:sans-serif;font-size:12px">' \
       '<rect width="{0}" height="{1}" fill="#fff"/>'


def bars(rows, title):
    """[(name, value > 0)] as horizontal bars on a logarithmic axis."""
    low = math.floor(math.log10(min(value for _, value in rows)) - 0.3)
    high = math.ceil(math.log10(max(value for _, value in rows)))
    width, left, height = 520, 130, 40 + 26 * len(rows)
    parts = [HEAD.format(width, height), f'<text x="{left}" y="18">{title}</text>']
    for i, (name, value) in enumerate(rows):
        y, length = 30 + 26 * i, (width - left - 100) * (math.log10(value) - low) / (high - low)
        parts.append(f'<rect x="{left}" y="{y}" width="{length:.1f}" height="18" fill="{COLOURS[i % 2]}"/>'
                     f'<text x="{left - 8}" y="{y + 13}" text-anchor="end">{name}</text>'
                     f'<text x="{left + length + 6:.1f}" y="{y + 13}">{value:,.0f}</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"


def lines(series, title_x, title_y):
    """{name: [(x, y)]}, both axes from 0."""
    width, height, left, bottom = 520, 300, 60, 46
    most_x = max(x for points in series.values() for x, _ in points)
    most_y = max(y for points in series.values() for _, y in points) * 1.05
    parts = [HEAD.format(width, height)]

    def place(x, y):
        return left + (width - left - 20) * x / most_x, height - bottom - (height - bottom - 20) * y / most_y

    for k in range(5):
        (x, _), (_, y) = place(most_x * k / 4, 0), place(0, most_y * k / 4)
        parts.append(f'<path d="M{left} {y:.1f}H{width - 20}M{x:.1f} {height - bottom}v5" stroke="#ccc"/>'
                     f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{most_y * k / 4:.3g}</text>'
                     f'<text x="{x:.1f}" y="{height - bottom + 18}" text-anchor="middle">{most_x * k / 4:.3g}</text>')
    for i, (name, points) in enumerate(series.items()):
        path = " ".join("{:.1f},{:.1f}".format(*place(x, y)) for x, y in points)
        parts.append(f'<polyline fill="none" stroke="{COLOURS[i % 5]}" stroke-width="2" points="{path}"/>'
                     f'<text x="{left + 10}" y="{32 + 15 * i}" fill="{COLOURS[i % 5]}">{name}</text>')
    parts.append(f'<text x="{(width + left) / 2}" y="{height - 8}" text-anchor="middle">{title_x}</text>'
                 f'<text x="{left}" y="14">{title_y}</text></svg>')
    return "\n".join(parts) + "\n"
