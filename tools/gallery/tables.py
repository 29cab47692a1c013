# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""The tables of the gradient report, in Markdown, from what `thalweg profile --json` measured."""

from collections.abc import Iterable


def number(x: float | None) -> str:
    return "-" if x is None else f"{x:.2g}"


def percent(share: float) -> str:
    return f"{100 * share:.2f}"


def table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    header = list(header)
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def strategies(profile: dict) -> str:
    header = ("strategy", "evaluations", "ns", "median", "p99", "max", "p99 near kinks", "wrong half %", "zero %", "NaN")
    rows = []
    for s in profile["strategies"]:
        smooth, kinks, both = s["away_from_kinks"], s["near_kinks"], s["all"]
        rows.append(
            (
                f"`{s['strategy']}`",
                f"{s['evaluations']:.2f}",
                f"{s['nanoseconds']:.1f}",
                number(smooth["median"]),
                number(smooth["p99"]),
                number(smooth["max"]),
                number(kinks["p99"]),
                percent(both["wrong_half_space"]),
                percent(both["vanished"]),
                str(both["nan"]),
            )
        )
    return table(header, rows)


def distances(profile: dict) -> str:
    bands = [band["distance_in_diagonals"] for band in profile["strategies"][0]["by_distance"]]
    rows = [(f"`{s['strategy']}`", *(number(b["p99"]) for b in s["by_distance"])) for s in profile["strategies"]]
    return table(("p99 at abs f of", *bands), rows)


def descents(profile: dict) -> str:
    """A table for each measure: methods down, strategies across."""
    rows = profile["descents"]
    methods = list(dict.fromkeys(row["method"] for row in rows))
    names = list(dict.fromkeys(row["strategy"] for row in rows))
    cells = {(row["method"], row["strategy"]): row for row in rows}
    measures = {
        f"misses of {rows[0]['hits']} overlaps": lambda d: str(d["misses"]),
        "p99 error of the value": lambda d: number(d["value_error_in_diagonals"]["p99"]),
        "iterations": lambda d: f"{d['iterations']:.1f}",
        "evaluations": lambda d: f"{d['evaluations']:.1f}",
        "ns a triangle": lambda d: f"{d['nanoseconds']:.0f}",
    }
    return "\n".join(
        table((title, *names), [(f"`{method}`", *(show(cells[method, name]) for name in names)) for method in methods])
        for title, show in measures.items()
    )


def best_offsets(profiles: dict) -> str:
    """For each scene and strategy the offset with the least median error away from kinks, and that error."""
    names = ("central", "forward", "simplex", "dichotomy")
    rows = []
    for scene, profile in profiles.items():
        row = [scene]
        sweeps = {sweep["strategy"]: sweep["offsets"] for sweep in profile["sweeps"]}
        for name in names:
            points = [p for p in sweeps.get(name, []) if p["away_from_kinks"]["median"] is not None]
            best = min(points, key=lambda p: p["away_from_kinks"]["median"], default=None)
            row.append("-" if best is None else f"{number(best['offset_in_diagonals'])}: {number(best['away_from_kinks']['median'])}")
        rows.append(row)
    return table(("scene", *names), rows)


def report(scenes: dict[str, str], profiles: dict, gallery: list[tuple[str, str]], plots: Iterable[str]) -> str:
    first = next(iter(profiles.values()))
    text = [
        "# Report of the gradient laboratory\n",
        "Written by `tools/report`; [Gradients](../gradients.md) says what follows from it. "
        f"One thread, {first['simd']}, {first['points']} points and {first['triangles']} triangles a scene, offset "
        f"`{first['gradient_offset']}`. Angles are radians from the gradient in double precision, away from kinks unless "
        "the column says otherwise; near a kink means that this gradient turns by 5 degrees within a thousandth of the "
        "scene. Errors of descents are the value minus the certified minimum, in diagonals of the scene. Times are of "
        "the run that wrote this page: compare them with each other.\n",
        "## Gallery\n",
    ]
    text += [f"![{caption}]({path})\n\n{caption}\n" for path, caption in gallery]
    text += ["## The offset of least error\n", "Offset in diagonals of the scene, and the median error there.\n", best_offsets(profiles)]
    for scene, meaning in scenes.items():
        text += [f"## {scene}: {meaning}\n", strategies(profiles[scene]), distances(profiles[scene]), descents(profiles[scene])]
        text += ["".join(f"![{plot.replace('_', ' ')}](plots/{scene}/{plot}.png)\n" for plot in plots)]
    return "\n".join(text)
