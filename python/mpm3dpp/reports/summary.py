# SPDX-License-Identifier: BSD-3-Clause
"""The head of the page: how the run ended, its figures, and what it told on its way."""

from __future__ import annotations

from mpm3dpp.base.markup import Html, bullets, details, element, escaped, joined, paragraph
from mpm3dpp.io.manifest import Manifest
from mpm3dpp.plots.labels import scaled
from mpm3dpp.run.report import often, summary_lines

from .document import Section
from .found import Found
from .numbers import duration


def head(found: Found) -> Html:
    """Return title, verdict and the most important figures."""
    word, sentence = verdict(found)
    title = found.title or found.folder.resolve().name
    facts = joined(
        element("div", joined([element("dt", name), element("dd", value)], ""))
        for name, value in _facts(found)
    )
    return joined(
        [
            element("h1", title),
            paragraph(sentence, f"verdict {word}"),
            element("dl", facts, class_="facts"),
        ]
    )


def verdict(found: Found) -> tuple[str, str]:
    """Return "completed", "failed" or "open", and a sentence on how the run ended, if it did."""
    manifest, reached = found.manifest, _reached(found)
    if manifest is None and found.goes_on:
        return "open", f"Still going on: it has reached {reached}. This page is of what is there."
    if manifest is None:
        rule = (
            f"Unfinished: it reached {reached} and has no manifest, which the end of a run writes"
        )
        if not (found.folder / "manifest.json").exists():
            return "open", f"{rule}; it was killed, or its disk was full."
        return "open", f"{rule}, or a damaged one."
    again = " It goes on now." if found.goes_on else ""
    if manifest.status == "failed":
        return "failed", f"Failed: {_sentence(manifest.reason)}{again}"
    if manifest.status == "interrupted":
        return "open", f"Stopped before its end, at {reached}: {_sentence(manifest.reason)}{again}"
    why = f" {_sentence(manifest.reason)}" if manifest.reason else ""
    made = f"{duration(manifest.wall_time)} of the clock, {manifest.particles:,} particles"
    return "completed", f"Finished at t = {reached}, in {made}.{why}{again}"


def _sentence(reason: str | None) -> str:
    reason = reason or "no reason is known"
    return reason if reason.endswith(".") else f"{reason}."


def _reached(found: Found) -> str:
    end = found.case.get("run", {}).get("end_time")
    time = scaled(found.time, "s")
    return (
        time if end is None or found.time >= end * (1 - 1e-9) else f"{time} of {scaled(end, 's')}"
    )


def _facts(found: Found) -> list[tuple[str, str]]:
    manifest, results = found.manifest, found.results
    facts = [("simulated time", scaled(found.time, "s"))]
    if manifest is not None:
        facts.append(("wall time", duration(manifest.wall_time)))
        facts.append(("particles", f"{manifest.particles:,}"))
        facts.append(("bodies", f"{manifest.contact.bodies:,}"))
    elif results is not None and len(results):
        last = found.read(lambda: results.arrays(-1, []))
        facts += [("particles", f"{len(last['position']):,}")] if last else []
    if found.steps is not None:
        facts.append(("steps", f"{found.steps:,}"))
    if results is not None:
        facts.append(("frames", f"{len(results):,}"))
    return facts


def happened(found: Found) -> Section:
    """Return the section on what the run told: warnings, notes, and its summary."""
    parts: list[str] = [element("p", problem, class_="verdict open") for problem in found.problems]
    manifest = found.manifest
    if manifest is None:
        parts.append(
            paragraph("Warnings, notes and the summary of a run are recorded when it ends.")
        )
        return _section(parts)
    if manifest.resumed_step:
        parts.append(
            paragraph(
                f"It went on from step {manifest.resumed_step:,} of an earlier part; times and "
                "energies are those of all parts together."
            )
        )
    told = [*_warnings(manifest), *map(_told, manifest.notes)]
    parts.append(bullets(told) or paragraph("There was nothing to warn of."))
    lines = "\n".join(summary_lines(manifest))
    parts.append(details("The summary, as the run printed it", element("pre", lines)))
    return _section(parts)


def _section(parts: list[str]) -> Section:
    return Section("happened", "What happened", joined(parts))


def _told(note: str) -> Html:
    kind, _, sentence = note.partition(": ")
    if kind not in ("note", "warning"):
        return escaped(note)
    return joined([element("strong", f"{kind.capitalize()}:"), sentence], " ")


def _warnings(manifest: Manifest) -> list[Html]:
    found = []
    for w in manifest.warnings:
        word = "Warning:" if w.is_error else "Note:"
        found.append(joined([element("strong", word), f"{w.message}; seen {often(w.count)}"], " "))
    return found
