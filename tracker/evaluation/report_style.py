"""The look of a report: light or dark as the reader's system says, fit for paper too."""

STYLE = """
:root { color-scheme: light dark; --ink: #1b1f24; --quiet: #565d68; --ground: #f6f7f8; --card: #fff; --line: #dcdfe4;
  --bar: #1c9c8f33; --accent: #046a5f; --worse: #b3261e; --better: #276a2b; }
@media (prefers-color-scheme: dark) { :root { --ink: #dfe2e6; --quiet: #a0a8b3; --ground: #17191d; --card: #1e2126;
  --line: #31363e; --bar: #36c3b43d; --accent: #5fd3c6; --worse: #ff8a81; --better: #82d486; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1120px; padding: 32px 24px 64px; background: var(--ground); color: var(--ink);
  font: 14px/20px Inter, system-ui, sans-serif; font-variant-numeric: tabular-nums; }
h1 { font-size: 24px; line-height: 32px; margin: 0 0 4px; }
h2 { font-size: 18px; line-height: 24px; margin: 40px 0 8px; }
h3 { font-size: 14px; margin: 16px 0 8px; }
.quiet { color: var(--quiet); }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
table { border-collapse: collapse; width: 100%; }
th, td { padding: 8px 12px; text-align: left; border-bottom: 1px solid var(--line); white-space: nowrap; }
tbody tr:last-child > * { border-bottom: 0; }
th { font-weight: 600; font-size: 12px; color: var(--quiet); }
tbody th { color: var(--ink); font-size: 14px; }
.number { text-align: right; }
.bar { background: linear-gradient(90deg, var(--bar) var(--share), transparent 0) no-repeat 0 100% / 100% 6px; }
.best { font-weight: 700; text-decoration: underline; text-underline-offset: 2px; }
.better { color: var(--better); } .worse { color: var(--worse); }
figure { margin: 0; padding: 12px; background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
figure > svg { width: 100%; height: auto; display: block; }
svg text { font-size: 11px; fill: var(--quiet); } svg .grid { stroke: var(--line); }
svg polyline { fill: none; stroke-width: 1.6; } svg.key { width: 24px; height: 8px; } svg.key line { stroke-width: 2; }
.legend { display: flex; flex-wrap: wrap; gap: 4px 16px; font-size: 12px; color: var(--quiet); margin-top: 8px; }
.legend span { display: inline-flex; gap: 6px; align-items: center; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(240px, 1fr)); gap: 12px; }
.pictures figure { padding: 0; overflow: hidden; } .pictures img { width: 100%; display: block; }
.pictures figcaption { padding: 8px 12px; font-size: 12px; }
.scale { display: inline-block; width: 96px; height: 8px; border-radius: 2px; vertical-align: middle; }
code { font: 12px ui-monospace, monospace; }
@media print { body { max-width: none; padding: 0; } figure, .scroll, tr { break-inside: avoid; } }
"""
