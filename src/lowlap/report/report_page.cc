#include "lowlap/report/internal/report_page.h"

namespace lowlap {

const char* const kReportStyle = R"css(
:root { color-scheme: light; --ink: #1d2733; --soft: #5c6b7a; --rule: #dfe4ea;
        --line: #d9822b; --camera: #1f7a4d; --warn: #a33a2a; }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); margin: 0 auto;
       max-width: 1080px; padding: 24px; }
h1 { font-size: 24px; margin: 0 0 16px; }
h2 { font-size: 17px; margin: 32px 0 4px; }
p { color: var(--soft); margin: 0 0 8px; }
ul { border-left: 4px solid var(--rule); list-style: none; padding: 4px 12px; }
ul.warnings { border-color: var(--warn); color: var(--warn); }
dl { display: flex; flex-wrap: wrap; gap: 12px; margin: 0 0 20px; }
dl div { border: 1px solid var(--rule); border-radius: 6px; padding: 8px 14px; }
dt { color: var(--soft); font-size: 12px; }
dd { font-size: 20px; font-weight: 600; margin: 0; }
canvas { width: 100%; height: 520px; border: 1px solid var(--rule);
         border-radius: 6px; cursor: grab; touch-action: none; }
.key b { font-weight: 600; }
div.table { max-height: 420px; overflow: auto; }
table { border-collapse: collapse; font-size: 13px; width: 100%; }
th, td { border-bottom: 1px solid var(--rule); padding: 3px 10px;
         text-align: right; white-space: nowrap; }
th { background: #fff; position: sticky; top: 0; }
th:first-child, td:first-child { text-align: left; }
)css";

const char* const kReportScript = R"js(
const canvas = document.getElementById('drawing');
const context = canvas.getContext('2d');
let yaw = 0.6, pitch = 0.9, zoom = 1, grip = null;
function project(list, n) {
  const x = list[n], y = list[n + 1], z = list[n + 2];
  const cy = Math.cos(yaw), sy = Math.sin(yaw);
  const cp = Math.cos(pitch), sp = Math.sin(pitch);
  const across = cy * x - sy * y, along = sy * x + cy * y;
  const size = 0.45 * zoom * Math.min(canvas.width, canvas.height);
  return [canvas.width / 2 + size * across,
          canvas.height / 2 - size * (sp * along + cp * z)];
}
function stroke(list, path, style, width) {
  context.strokeStyle = style;
  context.lineWidth = width;
  context.beginPath();
  path((from, to) => {
    const a = project(list, 3 * from), b = project(list, 3 * to);
    context.moveTo(a[0], a[1]);
    context.lineTo(b[0], b[1]);
  });
  context.stroke();
}
function draw() {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  context.fillStyle = '#fff';
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = 'rgba(40, 60, 90, 0.45)';
  for (let n = 0; n < drawing.points.length; n += 3) {
    const p = project(drawing.points, n);
    context.fillRect(p[0], p[1], 1.4 * ratio, 1.4 * ratio);
  }
  stroke(drawing.segments, line => {
    for (let n = 0; n < drawing.segments.length / 3; n += 2) line(n, n + 1);
  }, 'rgba(217, 130, 43, 0.75)', ratio);
  stroke(drawing.cameras, line => {
    for (let n = 0; n < drawing.cameras.length / 3; n += 5) {
      for (let c = 1; c <= 4; ++c) {
        line(n, n + c);
        line(n + c, n + c % 4 + 1);
      }
    }
  }, '#1f7a4d', 1.5 * ratio);
}
canvas.addEventListener('pointerdown', event => {
  grip = [event.clientX, event.clientY];
  canvas.setPointerCapture(event.pointerId);
});
canvas.addEventListener('pointermove', event => {
  if (!grip) return;
  yaw += 0.008 * (event.clientX - grip[0]);
  pitch += 0.008 * (event.clientY - grip[1]);
  pitch = Math.max(0, Math.min(Math.PI / 2, pitch));
  grip = [event.clientX, event.clientY];
  draw();
});
canvas.addEventListener('pointerup', () => { grip = null; });
canvas.addEventListener('wheel', event => {
  event.preventDefault();
  zoom *= Math.exp(-0.001 * event.deltaY);
  draw();
}, { passive: false });
window.addEventListener('resize', draw);
draw();
)js";

}  // namespace lowlap
