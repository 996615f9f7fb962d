"""The page: verdicts, incidents and plots in one file that needs no network."""

from collections.abc import Iterable
from html import escape
from typing import Any

from bokeh.embed import components
from bokeh.resources import Resources

from robot_control.data.report import time_plots
from robot_control.data.report.budgets import Judged, Verdict, failed
from robot_control.data.report.drive import Drive
from robot_control.data.report.incidents import Incident
from robot_control.data.report.other_plots import foot_lines, histograms, path_plot, time_lines
from robot_control.data.report.page_style import STYLE
from robot_control.data.report.style import TimeAxis
from robot_control.data.report.time_plots import drawn
from robot_control.files.files import printable

INCIDENTS_SHOWN = 60
MARKS, CLOSE_UPS = 50, 4
"""latched stops that are marked in every plot, and shown at full rate"""
SEVERITIES = ("stop", "brake", "warning", "note")
Section = tuple[str, str, list[Any]]
"""title, how to read it, plots"""


def page(drives: list[Drive], judged: list[list[Judged]], found: list[list[Incident]]) -> str:
    """The HTML of one drive, or of two that are compared; verdicts and incidents of each."""
    sections = [section for section in _sections(drives, found[0]) if section[2]]
    plots = [plot for _, _, section_plots in sections for plot in section_plots]
    script, divs = components(plots, wrap_script=False) if plots else ("", ())
    placed = iter(divs)
    body = "".join(
        f'<section id="s{i}"><h2>{escape(title)}</h2><p class="how">{escape(how)}</p>'
        + '<div class="plots">'
        + "".join(f'<div class="plot {plot.name or ""}">{next(placed)}</div>' for plot in section_plots)
        + "</div></section>"
        for i, (title, how, section_plots) in enumerate(sections)
    )
    links = "".join(f'<a href="#s{i}">{escape(title)}</a>' for i, (title, _, _) in enumerate(sections))
    title = " against ".join(printable(drive.name, 80) for drive in drives)
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{STYLE}</style>{Resources(mode='inline', components=['bokeh']).render()}</head><body>"
        f"<header><h1>{escape(title)}</h1>{_facts(drives, judged)}</header>"
        f'<nav><a href="#verdict">Verdict</a><a href="#incidents">Incidents</a>{links}</nav><main>'
        f"{_verdicts(drives, judged)}{_incidents(drives, found)}{body}"
        "<footer>Lines show the least and the largest value of every 1/1500 of the run: nothing is smoothed, no peak is"
        " left out. Drag to zoom all time plots together, scroll to zoom one axis, click a legend entry to hide a"
        " series.</footer></main>"
        # Names in a log are text from outside; none of them may end the script.
        f"<script>{script.replace('</', '<' + chr(92) + '/')}</script></body></html>"
    )


def _sections(drives: list[Drive], found: list[Incident]) -> Iterable[Section]:
    stops = [one for one in found if one.severity == 0][:MARKS] if len(drives) == 1 else []
    begin, end = min(float(one.time[0]) for one in drives), max(float(one.time[-1]) for one in drives)
    axis = TimeAxis(begin, end, [one.begin for one in stops])
    yield (
        "Stops at full rate",
        "Speeds around each latched stop, every cycle.",
        drawn(*(time_plots.close_up(drives[0], s.begin, f"{s.begin:.2f} s: {s.title}") for s in stops[:CLOSE_UPS])),
    )
    yield "Path", "Seen from above; the ellipses hold the true position with 95 %.", [path_plot(drives, found)]
    if len(drives) == 1:
        yield (
            "States and reasons",
            "Permits of the safety monitor, commands that the gate passed, and why a command was not executed as sent.",
            drawn(time_lines(axis, drives[0])),
        )
        yield (
            "Feet",
            "When each foot was in stance, as commanded or not.",
            drawn(foot_lines(axis, drives[0])),
        )
    yield (
        "Speeds",
        "Requested, after the limits, true where the log holds a truth, and estimated.",
        drawn(*(time_plots.speeds(axis, drives, which) for which in time_plots.UNITS)),
    )
    yield (
        "Tracking error",
        "Command after the limits minus estimate; the band is 2 σ of the estimate.",
        drawn(*(time_plots.tracking_error(axis, drives, which) for which in time_plots.UNITS)),
    )
    yield (
        "Joints",
        "Commanded and measured torque and speed of each joint.",
        time_plots.joint_plots(axis, drives, ("effort_command", "effort"), "N·m")
        + time_plots.joint_plots(axis, drives, ("velocity_command", "velocity_measured"), "rad/s"),
    )
    yield (
        "Position",
        "The true error of a consistent estimate is below 2 σ most of the time.",
        drawn(time_plots.position_plot(axis, drives)),
    )
    if len(drives) == 1:
        yield (
            "Innovations",
            "Normalised innovation squared of each sensor (1: it errs as much as its covariance states) and the "
            "confidence that follows from it.",
            time_plots.innovations(axis, drives[0]),
        )
    yield (
        "Latency",
        "For each cycle; only runs in wall-clock time have it.",
        drawn(time_plots.latency_plot(axis, drives)) + histograms(drives),
    )


def _facts(drives: list[Drive], judged: list[list[Judged]]) -> str:
    lines = []
    for drive, verdicts in zip(drives, judged, strict=True):
        wrong = failed(verdicts)
        by_name = {one.figure.name: one.figure.value for one in verdicts}
        duration = float(drive.time[-1] - drive.time[0])
        facts = [
            f"{duration:.1f} s",
            f"{drive.time.size} cycles at {1 / drive.period:.0f} Hz",
            f"{by_name['distance']:.1f} m",
            f"{by_name['latched_stops']:.0f} latched stops",
        ]
        count = sum(one.verdict is Verdict.OK for one in verdicts)
        badge = f'<b class="badge bad">{len(wrong)} FAILED</b>' if wrong else f'<b class="badge good">{count} ok</b>'
        name = f"<b>{escape(printable(drive.name, 80))}</b> " if len(drives) > 1 else ""
        part = f'<p class="part">{escape(drive.part)}</p>' if drive.part else ""
        lines.append(f"<p>{name}{badge}<span>{'</span><span>'.join(escape(fact) for fact in facts)}</span></p>{part}")
    return "".join(lines)


def _verdicts(drives: list[Drive], judged: list[list[Judged]]) -> str:
    heads = "".join(
        f"<th class='n'>{escape(printable(drive.name, 40)) if len(drives) > 1 else 'value'}</th>" for drive in drives
    )
    change = "<th class='n'>change</th>" if len(drives) > 1 else ""
    rows: list[str] = []
    rest: list[str] = []
    for figure in zip(*judged, strict=True):
        (rest if figure[0].verdict is Verdict.UNJUDGED else rows).append(_verdict_row(figure))
    head = f"<tr><th>figure</th>{heads}{change}<th class='n'>budget</th><th>verdict</th><th>meaning</th></tr>"
    return (
        f'<section id="verdict"><h2>Verdict</h2><div class="wide"><table>{head}{"".join(rows)}</table></div>'
        f"<details><summary>{len(rest)} figures without a budget</summary>"
        f'<div class="wide"><table>{head}{"".join(rest)}</table></div></details></section>'
    )


def _verdict_row(figure: tuple[Judged, ...]) -> str:
    first = figure[0]
    budget = " ".join(f"{sign} {first.figure.shown(bound)}" for sign, bound in first.bounds)
    worst = min(figure, key=lambda one: one.verdict is not Verdict.FAILED).verdict
    style = {Verdict.OK: "good", Verdict.FAILED: "bad"}.get(worst, "unknown")
    values = "".join(
        f'<td class="{"n bad" if one.verdict is Verdict.FAILED else "n"}">{one.figure.shown(one.figure.value)}</td>'
        for one in figure
    )
    if len(figure) > 1:
        values += f'<td class="n">{first.figure.shown(figure[1].figure.value - first.figure.value)}</td>'
    verdict = f'<b class="badge {style}">{worst.value}</b>' if worst.value else ""
    return (
        f"<tr><td>{escape(first.figure.name.replace('_', ' '))}</td>{values}"
        f'<td class="n">{budget}</td>'
        f"<td>{verdict}</td><td>{escape(first.figure.meaning)}</td></tr>"
    )


def _incidents(drives: list[Drive], found: list[list[Incident]]) -> str:
    lists = "".join(
        (f"<h3>{escape(printable(drive.name, 80))}</h3>" if len(drives) > 1 else "") + _incident_list(incidents)
        for drive, incidents in zip(drives, found, strict=True)
    )
    return f'<section id="incidents"><h2>Incidents</h2>{lists}</section>'


def _incident_list(found: list[Incident]) -> str:
    shown = sorted(sorted(found, key=lambda one: one.severity)[:INCIDENTS_SHOWN], key=lambda one: one.begin)
    if not shown:
        return '<p class="how">None.</p>'
    cards = "".join(
        f'<li class="{SEVERITIES[one.severity]}"><div><b>{one.begin:.2f} s</b>'
        f"<small>{_lasted(one)}</small></div><div><b>{escape(one.kind)}</b> {escape(printable(one.title))}"
        + "".join(f"<p>{escape(line)}</p>" for line in one.evidence)
        + "</div></li>"
        for one in shown
    )
    more = f'<p class="how">and {len(found) - len(shown)} less severe</p>' if len(found) > len(shown) else ""
    return f"<ol>{cards}</ol>{more}"


def _lasted(one: Incident) -> str:
    lasted = one.end - one.begin
    return f"for {lasted:.2f} s" if lasted >= 0.01 else f"for {1000 * lasted:.0f} ms"
