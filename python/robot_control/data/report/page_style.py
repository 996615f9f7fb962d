"""The style sheet of the page."""

STYLE = """
:root { --ink: #202124; --soft: #5f6368; --line: #e0e3e7; --good: #00734f; --bad: #b3261e; }
* { box-sizing: border-box; }
html { scroll-behavior: smooth; scroll-padding-top: 3.2rem; }
body { margin: 0; background: #f6f7f9; color: var(--ink);
  font: 15px/1.5 Inter, "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", sans-serif; }
header, main { max-width: 1240px; margin: 0 auto; padding: 0 24px; }
header { padding-top: 28px; padding-bottom: 12px; }
h1 { font-size: 26px; font-weight: 650; margin: 0 0 6px; overflow-wrap: anywhere; }
h3 { font-size: 15px; font-weight: 600; margin: 12px 0 0; }
h2 { font-size: 18px; font-weight: 650; margin: 0 0 2px; }
header p { margin: 4px 0; color: var(--soft); }
header span + span::before { content: "·"; margin: 0 8px; }
header .part { color: var(--bad); }
header .badge { margin-right: 12px; }
nav { position: sticky; top: 0; z-index: 20; background: #fffffff2; border-block: 1px solid var(--line);
  padding: 8px max(24px, calc((100vw - 1192px) / 2)); white-space: nowrap; overflow-x: auto; }
nav a { color: var(--soft); text-decoration: none; margin-right: 20px; font-size: 14px; }
nav a:hover { color: var(--ink); }
section { background: #fff; border: 1px solid var(--line); border-radius: 10px; padding: 18px 22px; margin: 16px 0; }
.how { color: var(--soft); margin: 0 0 8px; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; margin-top: 6px; }
th { text-align: left; color: var(--soft); font-weight: 500; border-bottom: 1px solid var(--line); padding: 5px 8px; }
td { border-bottom: 1px solid #f0f1f3; padding: 5px 8px; vertical-align: top; }
td:first-child { white-space: nowrap; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td:last-child { color: var(--soft); }
td.bad { color: var(--bad); font-weight: 600; }
.badge { display: inline-block; padding: 0 9px; border-radius: 10px; font-size: 13px; font-weight: 600;
  white-space: nowrap; }
.badge.good { background: #e3f4ec; color: var(--good); }
.badge.bad { background: #fde7e4; color: var(--bad); }
.badge.unknown { background: #eef0f2; color: var(--soft); font-weight: 500; }
details { margin-top: 12px; } summary { color: var(--soft); cursor: pointer; }
ol { list-style: none; margin: 8px 0 0; padding: 0; }
li { display: grid; grid-template-columns: 110px 1fr; gap: 14px; padding: 8px 12px; margin: 6px 0;
  border-left: 4px solid #9aa0a6; background: #f8f9fa; border-radius: 4px; }
li.stop { border-color: #d55e00; background: #fff5ef; } li.brake { border-color: #e69f00; background: #fffaf0; }
li.warning { border-color: #56b4e9; }
li small { display: block; color: var(--soft); } li p { margin: 1px 0; color: var(--soft); font-size: 14px; }
.plots { display: flex; flex-wrap: wrap; gap: 6px 16px; }
.plot { flex: 1 1 100%; min-width: 0; }
.plot.half { flex: 1 1 46%; min-width: 400px; }
footer { color: var(--soft); font-size: 13px; padding: 4px 2px 28px; }
@media print { nav { display: none; } section { break-inside: avoid; } }
"""
