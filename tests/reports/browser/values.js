// The value under the pointer at 0, with all curves, without one, and after the pointer left.
const plots=[...document.querySelectorAll('svg[data-x]')];
const svg=plots.find(s=>s.querySelector('title')?.textContent=='Toe angle');
// the pointer where the wheel travel is zero
const [x0,x1,low,high]=svg.dataset.x.split(' ').map(Number);
const at=new DOMPoint(x0+(0-low)/(high-low)*(x1-x0),50).matrixTransform(svg.getScreenCTM());
const point=()=>{
  svg.dispatchEvent(new PointerEvent('pointermove',{clientX:at.x,clientY:at.y}));
  return document.querySelector('.tip').textContent};
const before=point();
const entry=[...svg.querySelectorAll('g[data-e]')].find(g=>g.textContent=='vertical');
entry.dispatchEvent(new MouseEvent('click'));
const hidden=point();
entry.dispatchEvent(new MouseEvent('click'));
svg.dispatchEvent(new PointerEvent('pointerleave'));
const seen={before,hidden,again:point(),plots:plots.length,
  silent:plots.filter(s=>!s.querySelector('g[data-k] path')).length};
