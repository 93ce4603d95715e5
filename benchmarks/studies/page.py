"""The report as one HTML file that needs nothing else, in light and dark."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from benchmarks.studies.blocks import Block, Picture, Section, Table, Text

STYLE = """
:root{color-scheme:light dark;--bg:#fbfbfa;--sheet:#fff;--ink:#1b2330;--mute:#5b6676;--rule:#dfe3e9;--t16:#f3f1ea;
--accent:#1f66c7;--good:#1c7a52;--bad:#b42f2f;--badbg:#fdeeee}
@media(prefers-color-scheme:dark){:root{--bg:#0e1116;--sheet:#14181f;--ink:#e8ecf2;--mute:#9aa6b6;--rule:#2a313c;
--t16:#1e222a;--accent:#6aa5f5;--good:#58c497;--bad:#f28b8b;--badbg:#341c1f}}
*{box-sizing:border-box}body{margin:0;background:var(--bg);color:var(--ink);
font:16px/1.55 system-ui,-apple-system,"Segoe UI",sans-serif}
main{max-width:1120px;margin:0 auto;padding:56px 28px 96px}h1{font-size:34px;line-height:1.2;margin:0 0 20px;
letter-spacing:-.015em}h2{font-size:23px;margin:0;letter-spacing:-.01em}section{margin-top:64px;padding-top:28px;
border-top:1px solid var(--rule)}p{max-width:76ch;margin:12px 0}.lead p:first-child{font-size:18px}
.source{color:var(--mute);font-size:14px;margin:2px 0 10px}.question{font-size:17px;margin:6px 0 14px}
dl{display:grid;grid-template-columns:max-content 1fr;gap:4px 16px;margin:0 0 20px;font-size:14.5px;max-width:88ch}
dt{font-weight:600}dt.no{color:var(--bad)}dt.yes{color:var(--good)}dd{margin:0;color:var(--mute)}
figure{margin:22px 0}figcaption{color:var(--mute);font-size:13.5px;margin-top:8px;max-width:88ch}
.wide{overflow-x:auto;border:1px solid var(--rule);border-radius:8px;background:var(--sheet)}
table{border-collapse:collapse;width:100%;font-size:13.5px;font-variant-numeric:tabular-nums}
th,td{padding:6px 12px;text-align:right;border-top:1px solid var(--rule);white-space:nowrap}
thead th{border-top:0;font-weight:600;color:var(--mute);white-space:normal;vertical-align:bottom;line-height:1.3}
th:first-child,td:first-child,.words td,.words th{text-align:left}.words td{white-space:normal}
.words td:nth-child(3){text-align:right;white-space:nowrap}table.words{table-layout:fixed;min-width:640px}
.words th:first-child{width:38%}.words th:nth-child(3){width:88px;text-align:right}.words th:nth-child(4){width:96px}
.t16{background:var(--t16)}td.again{color:var(--mute);opacity:.5}td strong{color:var(--bad)}
td.met{color:var(--good)}td.unmet{background:var(--badbg)}
svg.plot{width:100%;height:auto;display:block;border:1px solid var(--rule);border-radius:8px}
nav{columns:2;column-gap:36px;margin:28px 0 0;font-size:14.5px}nav a{display:flex;gap:10px;break-inside:avoid;
padding:3px 0}nav span{color:var(--mute);min-width:78px}a{color:var(--accent);text-decoration:none}
a:hover{text-decoration:underline}code{font:13.5px ui-monospace,Menlo,monospace}
@media(max-width:640px){nav{columns:1}main{padding:32px 16px}dl{grid-template-columns:1fr}}
@media print{section{break-inside:avoid-page}body{background:#fff}}
"""


def write_page(title: str, preface: Sequence[str], sections: Sequence[Section]) -> str:
    """The whole file."""
    links = "".join(
        f'<a href="#{section.name}"><span>{escape(section.paper.split(",")[0].split(":")[0])}</span>'
        f"{escape(section.title)}</a>"
        for section in sections
    )
    lead = "".join(f"<p>{_inline(paragraph)}</p>" for paragraph in preface)
    body = "".join(_section(section) for section in sections)
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{escape(title)}</title><style>{STYLE}</style></head><body><main><h1>{escape(title)}</h1>"
        f'<div class="lead">{lead}</div><nav aria-label="Studies">{links}</nav>{body}</main></body></html>\n'
    )


def _section(section: Section) -> str:
    parts = [
        f'<section id="{section.name}"><h2>{escape(section.title)}</h2>',
        f'<p class="source">{_inline(section.paper)}</p><p class="question">{_inline(section.question)}</p>',
    ]
    if section.same:
        parts.append(
            f'<dl><dt class="yes">The same</dt><dd>{_inline(section.same)}</dd>'
            f'<dt class="no">Not comparable</dt><dd>{_inline(section.differs)}</dd></dl>'
        )
    return "".join([*parts, *(_block(block) for block in section.blocks), "</section>\n"])


def _block(block: Block) -> str:
    match block:
        case Text(text):
            return f"<p>{_inline(text)}</p>"
        case Picture(_, svg, caption):
            return f"<figure>{svg}<figcaption>{_inline(caption)}</figcaption></figure>"
        case Table(columns, rows, caption):
            is_paper = [column.startswith("T16") for column in columns]
            kinds = [' class="t16"' if paper else "" for paper in is_paper]
            head = "".join(f"<th{kind}>{_inline(name)}</th>" for kind, name in zip(kinds, columns, strict=True))
            body = "".join(_table_row(row, kinds, above) for row, above in zip(rows, ((), *rows), strict=False))
            name = ' class="words"' if columns[1:2] == ("measured",) else ""
            below = f"<figcaption>{_inline(caption)}</figcaption>" if caption else ""
            return (
                f'<figure><div class="wide"><table{name}><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
                f"</div>{below}</figure>"
            )


def _table_row(row: Sequence[str], kinds: Sequence[str], above: Sequence[str]) -> str:
    """A row; its first cell is faint where it says what the one above says."""
    first = ' class="again"' if row[:1] == above[:1] and not kinds[0] else kinds[0]
    cells = [_cell(cell, kind) for cell, kind in zip(row, (first, *kinds[1:]), strict=True)]
    return f"<tr>{''.join(cells)}</tr>"


def _cell(cell: str, kind: str) -> str:
    if cell in ("met", "**not met**"):
        kind = ' class="met"' if cell == "met" else ' class="unmet"'
    return f"<td{kind}>{_inline(cell or '–')}</td>"


def _inline(text: str) -> str:
    """`code`, **bold** and [links](x) of Markdown as HTML; everything else is escaped."""
    text = escape(text, quote=False)
    text = re.sub(r"`([^`]+)`", r"<code>\1</code>", text)
    text = re.sub(r"\*\*([^*]+)\*\*", r"<strong>\1</strong>", text)
    return re.sub(r"\[([^\]]+)\]\(([^)\s\"]+)\)", r'<a href="\2">\1</a>', text)
