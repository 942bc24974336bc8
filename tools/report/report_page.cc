#include "tools/report/report_page.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/drawing/svg.h"

namespace plumb::tools {

std::string_view PageStyle() {
  return R"(:root{color-scheme:light dark;--bg:#fff;--fg:#1d2329;--muted:#5d666f;--line:#d9dce0;--panel:#f5f6f7;--bad:#a8480a;--good:#2d7d70}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1180px;padding:28px 24px 60px;background:var(--bg);color:var(--fg);font:15px/1.5 system-ui,"Segoe UI",Roboto,Helvetica,Arial,sans-serif}
h1{font-size:24px;margin:0}h2{font-size:18px;margin:36px 0 10px}
.sub{color:var(--muted);margin:2px 0 20px}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));gap:10px}
.tile{background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:10px 14px}
.tile b{display:block;font-size:22px;font-variant-numeric:tabular-nums}.tile span{color:var(--muted);font-size:13px}
.note{border-left:3px solid var(--line);padding:2px 12px;color:var(--muted);margin:16px 0}
.note.bad{border-color:var(--bad);color:var(--fg)}
figure{margin:0 0 14px;border:1px solid var(--line);border-radius:6px;overflow:hidden}
figure svg{display:block;width:100%;height:auto;max-height:1000px}
figcaption{padding:8px 14px;border-bottom:1px solid var(--line);background:var(--panel);font-weight:600}
details{margin-top:12px}summary{cursor:pointer;color:var(--muted)}
.legend{display:flex;flex-wrap:wrap;gap:8px 22px;align-items:center;margin:0 0 12px;font-size:13px;color:var(--muted)}
.legend svg{vertical-align:middle;margin-right:6px}
.legend label{white-space:nowrap}
table{border-collapse:collapse;width:100%;font-size:14px;font-variant-numeric:tabular-nums}
th,td{padding:6px 10px;border-bottom:1px solid var(--line);text-align:right;vertical-align:top}
th{color:var(--muted);font-weight:600;font-size:13px;border-bottom-width:2px}
th.t,td.t{text-align:left}td small{color:var(--muted);display:block;font-size:12px}
tr.off td{background:var(--panel)}
.chip{display:inline-block;min-width:22px;padding:0 6px;border-radius:11px;color:#fff;text-align:center;font-weight:700}
.scroll{overflow-x:auto}
footer{margin-top:40px;color:var(--muted);font-size:13px}footer dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 14px}dd{margin:0;overflow-wrap:anywhere}
@media (prefers-color-scheme:dark){:root{--bg:#15181b;--fg:#e4e7ea;--muted:#9aa3ab;--line:#343a40;--panel:#1d2125;--bad:#f0a05a;--good:#6cc3b4}
.plan{--ink:#d5dade!important;--paper:#15181b!important;--floor:#1f2428!important;--soft:#7b858e!important;--light:#474e55!important;--glass-line:#7ab8dd!important}}
@media print{:root{color-scheme:light;--bg:#fff;--fg:#000;--muted:#444;--line:#bbb;--panel:#fff}
.plan{--ink:#1d2329!important;--paper:#fff!important;--floor:#f7f6f2!important;--soft:#8b939b!important;--light:#c9ccd0!important;--glass-line:#3f7fa8!important}
body{max-width:none;padding:0;font-size:11px}.screen{display:none}figure,tr{break-inside:avoid}*{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";
}

std::string_view PageScript() {
  return R"(const pair=t=>t.split(' ').map(Number);
function exaggerate(k){for(const e of document.querySelectorAll('.dev')){const d=e.dataset,a=pair(d.a),b=pair(d.b),u=pair(d.da),v=pair(d.db);
const p=`${a[0]+k*u[0]} ${a[1]+k*u[1]}`,q=`${b[0]+k*v[0]} ${b[1]+k*v[1]}`;
e.setAttribute('d',e.classList.contains('built')?`M${p}L${q}`:`M${d.a}L${d.b}L${q}L${p}Z`)}}
for(const r of document.querySelectorAll('input[name=times]'))r.addEventListener('change',()=>exaggerate(Number(r.value)));
for(const c of document.querySelectorAll('input[data-layer]'))c.addEventListener('change',()=>{
for(const g of document.querySelectorAll('.'+c.dataset.layer))g.style.display=c.checked?'':'none'});
)";
}

std::string LegendHtml(double limit_m) {
  std::string stops;
  for (int i = 0; i <= 8; ++i) {
    stops += fmt::format("<stop offset=\"{:.3f}\" stop-color=\"{}\"/>", i / 8.0, DeviationColor((i / 4.0 - 1) * limit_m, limit_m));
  }
  std::string times;
  for (int i = 0; i <= 4; ++i) times += fmt::format("<stop offset=\"{:.2f}\" stop-color=\"{}\"/>", i / 4.0, TimeColor(i / 4.0));
  const long limit_cm = std::lround(100 * limit_m);
  return fmt::format(
      R"html(<div class="legend">
<span>&minus;{0} cm <svg width="130" height="12"><defs><linearGradient id="dev">{1}</linearGradient></defs><rect width="130" height="12" fill="url(#dev)"/></svg>+{0} cm where it was built; + is further into the room</span>
<span><svg width="28" height="12"><path d="M0 6H28" stroke="#4f9d8f" stroke-width="6"/></svg>as planned</span>
<span><svg width="28" height="12"><path d="M2 6H28" stroke="#8b939b" stroke-width="2.5" stroke-dasharray="2 8" stroke-linecap="round"/></svg>not observed</span>
<span><svg width="28" height="12"><rect x="2" y="2" width="24" height="8" stroke="#d32f2f" stroke-width="2" stroke-dasharray="5 3" fill="none"/></svg>missing: planned, not built</span>
<span><svg width="28" height="12"><rect x="2" y="2" width="24" height="8" fill="#1565c0"/></svg>built, in no plan</span>
<span><svg width="28" height="12"><rect x="2" y="2" width="24" height="8" stroke="#b8860b" stroke-width="2" fill="#ffd54f"/></svg>doorway as built, elsewhere or of another width</span>
<span><svg width="60" height="12"><defs><linearGradient id="time">{2}</linearGradient></defs><rect y="3" width="60" height="6" fill="url(#time)"/></svg>way, from start to end</span>
</div>
<div class="legend screen"><span>deviations drawn <label><input type="radio" name="times" value="1" checked> to scale</label>
<label><input type="radio" name="times" value="3"> &times;3</label> <label><input type="radio" name="times" value="10"> &times;10</label></span>
<label><input type="checkbox" data-layer="layer-surfaces" checked> surfaces</label>
<label><input type="checkbox" data-layer="layer-way" checked> way</label>
<label><input type="checkbox" data-layer="layer-rooms" checked> rooms</label></div>
)html",
      limit_cm, stops, times);
}

}  // namespace plumb::tools
