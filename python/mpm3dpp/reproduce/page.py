# SPDX-License-Identifier: BSD-3-Clause
"""The page of `mpm3dpp reproduce`, as Markdown and the same as HTML."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mpm3dpp.base.ours import MARK
from mpm3dpp.reports.document import document

from . import paper
from .examples import Example, change_lines
from .pictures import Picture
from .runs import Done, Measured
from .tables import comparison, markdown

TITLE = "The examples of Ma, Zhang & Huang (2010), run here"
_SOURCE = (
    "Z. T. Ma, X. Zhang and P. Huang, *An Object-Oriented MPM Framework for Simulation of Large "
    "Deformation and Contact of Numerous Grains*, CMES: Computer Modeling in Engineering & "
    "Sciences 55 (1), 2010, section 4"
)


def compose(
    measured: list[Measured],
    pictures: dict[int, list[Picture]],
    missing: list[Example],
    size: str,
    build: dict[str, Any],
) -> str:
    """Return the page as Markdown.

    Args:
        measured: the examples that ran.
        pictures: ours in place of each figure, in the folder of the page.
        missing: the examples whose case files are not there.
        size: "quick" or "paper".
        build: `version`, `machine`, `isa`, `threads`.
    """
    parts = [
        f"# {TITLE}",
        f"{_SOURCE}; beside what it says, what this build does. Size: **{size}**"
        + (", which is smaller than the paper's examples." if size == "quick" else ".")
        + f" MPM3Dpp {build['version']}, {build['machine']}, {build['isa']}, "
        f"threads: {build['threads']}.",
        *(_example(found, pictures, size) for found in measured),
    ]
    if missing:
        names = ", ".join(f"{example.name} (section {example.section})" for example in missing)
        parts.append(f"Not run, because the case files are not there: {names}.")
    parts.append(_differences(size, build))
    return "\n\n".join(parts) + "\n"


def _example(found: Measured, pictures: dict[int, list[Picture]], size: str) -> str:
    example = found.example
    parts = [f"## {example.section} {example.title}"]
    parts += [f"**Not as it should be:** {sentence}." for sentence in found.wrong]
    parts.append("\n".join(_run_line(done, example) for done in found.runs))
    if example.particles is not None:
        head = ["", "paper", f"here, {size}"]
        ours = found.runs[-1].manifest["particles"]
        rows = [["particles", f"{example.particles:,}", f"{ours:,}"]]
        parts.append("\n".join(markdown(head, rows)))
    if example.table is not None:
        parts += [
            f"### Table {example.table.number}: {example.table.title}",
            "\n".join(comparison(example.table, found, size)),
            _how_timed(found),
        ]
    parts += [_figure(paper.FIGURES[n], pictures.get(n, [])) for n in example.figures]
    return "\n\n".join(parts)


def _run_line(done: Done, example: Example) -> str:
    manifest = done.manifest
    changes = "; ".join(f"`{line}`" for line in change_lines(done.changes))
    return (
        f"- `examples/{example.files[done.label]}` with {changes}: {manifest['status']}, "
        f"{manifest['steps']:,} steps of {manifest['particles']:,} particles in "
        f"{manifest['wall_time']:.1f} s."
    )


def _how_timed(found: Measured) -> str:
    timed, example = found.timed, found.example
    if timed is None:
        return "Time and memory could not be measured."
    begin = ""
    if example.timed_from:
        begin = f", from {example.timed_from:.0%} of the end time on"
    return (
        f"Times here: medians of {len(timed.blocks['on'])} blocks, {timed.steps} steps in all, "
        f"taken in turns{begin}; ratios are medians over pairs of blocks. Without contact "
        "(`contact.enabled = false`) the bodies do not see each other, so that they do not load "
        "each other either, and a material that would yield has less to do. Bonded "
        "(`contact.bonded = true`) they have one velocity field, as the method has it without a "
        "contact algorithm; the paper does not say which of the two it means by disabled. Its "
        "ratios MPM3D / MPM3Dpp are of its two programs on its machine, so there are none here. "
        "Memory of the core: what it holds for particles, grid and contact, reserved room "
        "included. The paper's is that of the whole program, its M taken as MiB: compare it with "
        "that of the process, the most that was resident in the whole run, with Python, its "
        "libraries and frames."
    )


def _figure(figure: paper.Figure, pictures: list[Picture]) -> str:
    lines = [f"### Figure {figure.number}: {figure.title}", f"{figure.shows} {figure.differs}"]
    if len(pictures) > 1:  # Two beside each other.
        rows = [pictures[k : k + 2] for k in range(0, len(pictures), 2)]
        cells = [[_image(p, figure) for p in row] for row in rows]
        cells = [[*row, ""][:2] for row in cells]
        lines.append("\n".join(markdown(["", ""], cells)))
    elif pictures:
        lines.append(f"{_image(pictures[0], figure)}\n\n*Here: {pictures[0].caption}.*")
    else:
        lines.append("There is no picture, because the run gave nothing to draw.")
    return "\n\n".join(lines)


def _image(picture: Picture, figure: paper.Figure) -> str:
    return f"![In place of figure {figure.number}: {picture.caption}]({picture.path.name})"


def _differences(size: str, build: dict[str, Any]) -> str:
    lines = [
        "## What differs",
        f"- The machine: {paper.MACHINE}, against {build['machine']}. Compare ratios, not times.",
        "- The paper's figures are described, not shown: they are its publisher's.",
        "- Tiles: this program makes cells in blocks of 4 x 4 x 4 where particles are, for each "
        "body by itself; the paper's makes single cells, with nodal values for several bodies only "
        "where they meet.",
        "- The direction of contact is that of the plane between the particles of two bodies; the "
        "paper's comes from the normal vectors of the bodies at the nodes.",
        "- Numbers that the paper does not give, and that the case files choose:",
        *(f"  - {sentence}" for sentence in paper.NOT_GIVEN),
    ]
    if size == "quick":
        lines.insert(1, "- The size: quick; `--size paper` runs the case files as they are.")
    return "\n".join([lines[0], "", *lines[1:]])


def as_html(text: str, title: str = TITLE) -> str:
    """Return a page of Markdown with tables as a page of HTML."""
    from markdown_it import MarkdownIt

    return document(title, MarkdownIt("commonmark").enable("table").render(text))


def write(text: str, out: Path) -> list[Path]:
    """Write the page as `reproduce.md` and `reproduce.html`; return the two paths.

    Raises:
        CaseError: they cannot be written.
    """
    from mpm3dpp.base.disk import write_atomically

    paths = [out / "reproduce.md", out / "reproduce.html"]
    for path, content in zip(paths, (f"{text}\n<!-- {MARK} -->\n", as_html(text)), strict=True):
        write_atomically(path, content)
    return paths
