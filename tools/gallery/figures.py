# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""The pictures of the gradient report: rendered by thalweg, put together and labelled by gnuplot."""

import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import paths

@dataclass
class Panel:
    """A picture with a title, and polylines over it in the scene's own coordinates. Their colours are Okabe and Ito's,
    which the common kinds of colour blindness keep apart."""

    title: str
    picture: Path
    bounds: tuple[float, float, float, float]
    lines: list[tuple[str, str, list[tuple[float, float]]]] = field(default_factory=list)  # style, colour, points

    def size(self) -> tuple[int, int]:
        with self.picture.open("rb") as file:
            header = file.read(24)
        return int.from_bytes(header[16:20], "big"), int.from_bytes(header[20:24], "big")


class Studio:
    def __init__(self, program: Path, scenes: Path, out: Path):
        self.program, self.scenes, self.out = program, scenes, out
        self.rooms = tempfile.TemporaryDirectory()
        self.folder = Path(self.rooms.name)
        self.count = 0

    def scene(self, name: str) -> Path:
        return self.scenes / f"{name}.json"

    def render(self, title: str, scene: str, bounds: tuple, *arguments: str, width: int = 250) -> Panel:
        self.count += 1
        picture = self.folder / f"{self.count}.png"
        height = round(width * (bounds[3] - bounds[1]) / (bounds[2] - bounds[0]))
        view = ("--bounds", *map(str, bounds), "--size", str(width), str(height))
        command = [self.program, "render", self.scene(scene), "-o", picture, "--quiet", *view, *arguments]
        subprocess.run(command, check=True)
        return Panel(title, picture, bounds)

    def compose(self, name: str, title: str, panels: list[Panel], columns: int) -> str:
        """One labelled picture of panels of one size, row by row, pixel for pixel."""
        rows = -(-len(panels) // columns)
        panel_width, panel_height = panels[0].size()
        edge, gap, heading, head = 8, 10, 30, 36  # pixels; a heading stands over each panel
        width = 2 * edge + columns * panel_width + (columns - 1) * gap
        height = head + rows * (panel_height + heading) + edge
        margins = f"{edge / width},{1 - edge / width},{edge / height},{1 - (head + heading) / height}"
        script = [
            f"set terminal pngcairo size {width},{height} font 'sans,10' noenhanced",
            f"set output '{self.out / name}.png'",
            f"set multiplot layout {rows},{columns} title '{title}' margins {margins} spacing {gap / width},{heading / height}",
            "unset border; unset tics; unset key; set size ratio -1",
        ]
        for panel in panels:
            script += self.panel(panel)
        script.append("unset multiplot")
        subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)
        return f"{name}.png"

    @staticmethod
    def panel(panel: Panel) -> list[str]:
        x0, y0, x1, y1 = panel.bounds
        width, height = panel.size()
        dx, dy = (x1 - x0) / width, (y1 - y0) / height
        place = f"dx={dx} dy={dy} origin=({x0 + dx / 2},{y0 + dy / 2})"
        parts = [f"'{panel.picture}' binary filetype=png {place} with rgbimage"]
        parts += [f"'-' using 1:2 with {style} linecolor rgb '{colour}'" for style, colour, _ in panel.lines]
        script = [f"set title '{panel.title}' offset 0,-0.6", f"set xrange [{x0}:{x1}]; set yrange [{y0}:{y1}]"]
        script.append("plot " + ", ".join(parts))
        for _, _, points in panel.lines:
            script += [f"{x} {y}" for x, y in points] + ["e"]
        return script


THESIS = (450, 100, 1400, 950)


def as_colour(studio: Studio) -> tuple[str, str]:
    gradient = lambda title, *more: studio.render(title, "small", THESIS, "--mode", "gradient", *more)  # noqa: E731
    at = lambda strategy, o: ("--gradient", strategy, "--gradient-offset", o)  # noqa: E731
    panels = [
        gradient("central differences, o = 0.00005", *at("central", "0.00005")),
        gradient("central differences, o = 0.005", *at("central", "0.005")),
        gradient("central differences, o = 50", *at("central", "50")),
        gradient("dichotomy, o = 0.00005", *at("dichotomy", "0.00005")),
        gradient("dichotomy, o = 0.005", *at("dichotomy", "0.005")),
        gradient("dichotomy, o = 50", *at("dichotomy", "50")),
        gradient("dichotomy, o by the rule of the thesis", *at("dichotomy", "0.005,f:0.00025")),
        gradient("dichotomy of |f|, as published", *at("dichotomy:verbatim", "0.005")),
        gradient("closed forms (autodiff)"),
    ]
    caption = (
        "The gradient of the thesis' scene as colour, hue for direction (the disc on the left has them all) and darker "
        "inside: figures 3 and 4 of the thesis. Small offsets drown differences and the dichotomy in rounding, large ones "
        "smear the creases, the rule for o lies between, and closed forms need none."
    )
    return studio.compose("gradient", "The gradient as colour", panels, 3), caption


def as_error(studio: Studio) -> tuple[str, str]:
    error = lambda title, *more: studio.render(title, "small", THESIS, "--mode", "error", *more)  # noqa: E731
    rule = ("--gradient-offset", "0.005,f:0.00025")
    panels = [
        error("closed forms (autodiff)"),
        error("central", "--gradient", "central", *rule),
        error("forward", "--gradient", "forward", *rule),
        error("central, o = 1e-3 of the scene", "--gradient", "central", "--gradient-offset", "scene:1e-3"),
        error("dichotomy", "--gradient", "dichotomy", *rule),
        error("dichotomy of |f|, as published", "--gradient", "dichotomy:verbatim"),
    ]
    caption = "The angle from the gradient in double precision, on a logarithmic scale: dark is right, light is wrong."
    return studio.compose("error", "Error of the direction, by strategy", panels, 3), caption


def kinks(studio: Studio) -> tuple[str, str]:
    bounds = (-2.6, -2.4, 2.6, 2.4)
    panels = [
        studio.render("gradient of a bound", "subtractions", bounds, "--mode", "gradient"),
        studio.render("direction from the nearest point", "subtractions", bounds, "--mode", "gradient", "--gradient", "closest_point"),
        studio.render("their difference", "subtractions", bounds, "--mode", "error", "--gradient", "closest_point"),
    ]
    caption = (
        "Where f is only a bound, outside of corners that subtraction leaves, its gradient is not the direction from the "
        "nearest surface point; closest_point searches for that point."
    )
    return studio.compose("closest_point", "A field that is only a bound", panels, 3), caption


def with_descent(studio: Studio, panel: Panel, scene: str, triangle: list, how: tuple[str, str]) -> Panel:
    """The triangle, the path of a descent from the centroid, and a ring around the proven deepest point."""
    centroid = (sum(x for x, _ in triangle) / 3, sum(y for _, y in triangle) / 3)
    path = paths.descent(studio, scene, triangle, *how)
    if how[0].startswith("thesis"):
        path.insert(0, centroid)
    panel.lines = [
        ("lines linewidth 2", "#000000", [*triangle, triangle[0]]),
        ("linespoints pointtype 7 pointsize 0.6 linewidth 2", "#009E73", path),
        ("points pointtype 7 pointsize 1.4", "#D55E00", path[-1:]),
        ("points pointtype 6 pointsize 2.2 linewidth 2", "#000000", [paths.deepest(studio, scene, triangle)]),
    ]
    return panel


LEGEND = "green the path, one dot an iteration, vermilion its end, the black ring the proven deepest point"


def descents(studio: Studio) -> tuple[str, str]:
    """Figure 5 of the thesis: descents in a triangle over distance bands."""
    triangle = [(905, 800), (1135, 905), (690, 890)]
    bounds = (660, 690, 1160, 920)
    panels = []
    for title, *how in (
        ("as published: dichotomy of |f|", "thesis", "dichotomy:verbatim"),
        ("published step, closed forms", "thesis", "autodiff"),
        ("projected, closed forms", "projected", "autodiff"),
        ("projected, forward differences", "projected", "forward"),
    ):
        panel = studio.render(title, "small", bounds, "--mode", "distance", width=400)
        panels.append(with_descent(studio, panel, "small", triangle, tuple(how)))
    caption = f"Descents in a triangle over bands of distance (figure 5 of the thesis): {LEGEND}."
    return studio.compose("descents", "Descents in a triangle", panels, 2), caption


def limits(studio: Studio) -> tuple[str, str]:
    """Figure 6 of the thesis: where one start ends, and what it misses."""
    bounds = (-5, -2.6, 5, 4.8)
    panels = []
    for triangle in ([(-4.4, -0.6), (4.3, -1.6), (0.4, 4.2)], [(-4.6, 1.4), (4.6, 1.9), (-1, -1.9)]):
        for title, *how in (("as published", "thesis", "dichotomy:verbatim"), ("projected", "projected", "autodiff")):
            panel = studio.render(title, "stars", bounds, "--mode", "distance", width=400)
            panels.append(with_descent(studio, panel, "stars", triangle, tuple(how)))
    caption = (
        "Triangles over several minima (figure 6 of the thesis shows the like). The published floor of the step, mu = 100, "
        f"was made for pixels: on a scene ten units wide it leaps from edge to edge. {LEGEND.capitalize()}."
    )
    return studio.compose("limits", "What one start can miss", panels, 2), caption


def draw_all(studio: Studio) -> list[tuple[str, str]]:
    return [draw(studio) for draw in (as_colour, as_error, kinks, descents, limits)]
