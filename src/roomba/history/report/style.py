"""How reports look: the page's own colours, light and dark."""

from typing import Final

STYLE: Final = """\
:root{--paper:#f6f3ee;--sheet:#fff;--ink:#2b2e33;--quiet:#5c6068;--line:#d9d4ca;--accent:#00694c;\
--warn:#b34a00;color-scheme:light}
@media (prefers-color-scheme:dark){:root{--paper:#1d1f22;--sheet:#282b30;--ink:#eceae6;\
--quiet:#b3b7be;--line:#43474e;--accent:#4fd0a3;--warn:#ffb066;color-scheme:dark}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.4 system-ui,sans-serif}
main{max-width:1100px;margin:0 auto;padding:16px;display:flex;flex-direction:column;gap:16px}
h1,h2,p,figure,pre{margin:0}h1{font-size:1.375rem}h2{font-size:1rem;margin-bottom:8px}
section{background:var(--sheet);border:1px solid var(--line);border-radius:8px;padding:16px}
.headline{font-weight:600}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;width:100%}
th,td{text-align:left;padding:4px 16px 4px 0;border-bottom:1px solid var(--line);\
vertical-align:top}
th{color:var(--quiet);font-weight:400}thead th,.wide td:not(:last-child){white-space:nowrap}
.pairs tbody{display:grid;\
grid-template-columns:repeat(auto-fill,minmax(260px,1fr));\
column-gap:32px}.pairs tr{display:flex;border-bottom:1px solid var(--line)}
.pairs th{flex:0 0 88px}.pairs th,.pairs td{border:0}
.wide{overflow-x:auto}
svg{display:block;width:100%;max-height:640px;background:#f1ede5;border-radius:8px;color:#2b2e33}
.charts{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,440px),1fr));\
gap:16px}
svg.chart{background:none;overflow:visible}
.quiet{color:var(--quiet)}
.way{fill:none;stroke:#2b2e33;stroke-opacity:.45;stroke-width:1.6;stroke-linejoin:round}
.ring{fill:none;stroke:#b7ae9f;stroke-width:1.5}
.station{stroke:#2b2e33;stroke-width:5;fill:none}
.missed{fill:#f0a582;fill-opacity:.6;stroke:#b34a00;stroke-width:3}
svg text{font:22px system-ui,sans-serif;text-anchor:middle;dominant-baseline:middle;fill:#2b2e33;\
stroke:#fffffe;stroke-opacity:.85;stroke-width:5;paint-order:stroke}
svg .number{font-weight:700}svg .size{font-size:15px}
svg.chart text{font-size:15px;text-anchor:start;\
dominant-baseline:auto;fill:var(--quiet);stroke:none}
svg.chart .end{text-anchor:end}
.axis{fill:none;stroke:var(--line)}.line{fill:none;stroke:var(--accent);stroke-width:1.5}
.mark{fill:var(--accent)}
.legend{display:flex;flex-wrap:wrap;gap:16px;margin-top:8px;color:var(--quiet);font-size:.875rem}
.legend i{display:inline-block;width:14px;height:14px;margin-right:6px;vertical-align:-2px;\
border:1px solid var(--line)}
.c1{background:#c7e7d9}.c2{background:#92cfb5}.c3{background:#5cb28f}.cm{background:#f0a582}
pre{white-space:pre-wrap;overflow-wrap:anywhere;font-size:.875rem}
.sides{display:grid;grid-template-columns:1fr 1fr;gap:16px}
.side{display:flex;flex-direction:column;gap:16px;min-width:0}
@media (max-width:599px){svg.chart text{font-size:20px}th,td{padding-right:10px}\
.reasons thead{position:absolute;clip-path:inset(50%)}\
.reasons tr{display:flex;flex-wrap:wrap;border-bottom:1px solid var(--line)}\
.reasons td{border:0;padding:2px 10px 2px 0}.reasons td:last-child{flex-basis:100%}}
@media (max-width:899px){.sides{grid-template-columns:1fr}}
"""
