# SPDX-License-Identifier: BSD-3-Clause
"""The look of our pages: light and dark, on paper and on a phone."""

STYLE = """\
:root {
  color-scheme: light dark;
  --ink: #1d2125; --soft: #5b646d; --paper: #ffffff; --shade: #f3f5f7; --rule: #dde1e5;
  --link: #0062a0; --bar: #0072b2; --good: #00734f; --bad: #b5420a; --open: #8a6100;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ink: #e3e6e8; --soft: #a2abb3; --paper: #15181b; --shade: #1f2428; --rule: #363d44;
    --link: #74bdf0; --bar: #3a97d4; --good: #41c795; --bad: #f0854a; --open: #e2b341;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif;
}
main { max-width: 66rem; margin: 0 auto; padding: 1.5rem 1rem 3rem; overflow-wrap: anywhere; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0.5rem 0; }
h2 {
  font-size: 1.25rem; margin: 2.5rem 0 0.75rem; padding-top: 0.75rem;
  border-top: 1px solid var(--rule);
}
h3 { font-size: 1rem; margin: 1.5rem 0 0.5rem; }
p, ul, ol { max-width: 46rem; }
a { color: var(--link); }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
main > table { display: block; margin: 1rem 0; overflow-x: auto; }
.wide { overflow-x: auto; margin: 1rem 0; overflow-wrap: normal; }
td, th {
  padding: 0.25rem 0.7rem 0.25rem 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--rule);
}
th { color: var(--soft); font-weight: 600; vertical-align: bottom; }
.number { text-align: right; white-space: nowrap; padding-left: 0.7rem; padding-right: 0; }
th.number { white-space: normal; }
code, pre { font-family: ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
code, pre { font-size: 0.85rem; background: var(--shade); }
pre { padding: 0.75rem 1rem; overflow-x: auto; overflow-wrap: normal; line-height: 1.45; }
summary { cursor: pointer; color: var(--link); }
details { margin: 0.75rem 0; }
.verdict { font-size: 1.1rem; padding: 0.6rem 0.9rem; border-left: 0.3rem solid var(--soft); }
.verdict { background: var(--shade); max-width: none; }
.completed { border-color: var(--good); }
.failed { border-color: var(--bad); }
.open { border-color: var(--open); }
.facts { display: flex; flex-wrap: wrap; gap: 0.75rem 2rem; margin: 1rem 0; }
.facts div { min-width: 6rem; }
.facts dt { color: var(--soft); font-size: 0.85rem; }
.facts dd { margin: 0; font-size: 1.1rem; font-variant-numeric: tabular-nums; }
nav ol { columns: 14rem; padding-left: 1.4rem; }
figure { margin: 1.25rem 0; }
figcaption { color: var(--soft); font-size: 0.9rem; }
img { max-width: 100%; max-height: 36rem; background: #ffffff; border-radius: 0.3rem; }
.curves { overflow-x: auto; }
.curves svg { display: block; width: 100%; min-width: 30rem; max-width: 50rem; height: auto; }
.curves svg * { stroke-linejoin: round; stroke-linecap: butt; }
.bar { min-width: 8rem; width: 40%; vertical-align: middle; }
.bar span {
  display: block; height: 0.75rem; background: var(--bar); min-width: 1px;
  print-color-adjust: exact; -webkit-print-color-adjust: exact;
}
footer { margin-top: 3rem; color: var(--soft); font-size: 0.85rem; }
@media print {
  :root { --ink: #000000; --paper: #ffffff; --shade: #f3f5f7; --rule: #cccccc; --soft: #444444; }
  main { max-width: none; padding: 0; }
  body { font-size: 10pt; }
  nav { display: none; }
  figure, tr, .verdict { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  .wide, .curves, pre { overflow: visible; }
  pre { white-space: pre-wrap; }
  img { max-height: 22cm; }
  details::details-content { content-visibility: visible; block-size: auto; }
}
"""
