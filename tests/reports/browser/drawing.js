// Functions on the drawing that is turned by hand: its controls, and the places of the wheel
// centres on the sheet, by the thick lines that end there.
const d=JSON.parse(document.querySelector('script.motion').textContent);
const svg=document.querySelector('.turn svg');
const fixed=document.querySelector('svg.still'),slider=document.querySelector('.turn input');
const shown=()=>document.querySelector('.turn output').textContent;
const buttons=()=>[...document.querySelectorAll('.turn button')];
const press=name=>buttons().find(b=>b.textContent==name).click();
const slide=v=>{slider.value=v;slider.dispatchEvent(new Event('input'))};
const thick=d.list.links.filter(l=>['body','rod','beam'].includes(l.kind)).map(l=>l.points);
const place=k=>{const n=thick.findIndex(l=>l.includes(k)),
  path=svg.querySelectorAll('path[stroke-width="3"]')[n],
  ends=path.getAttribute('d').slice(1).split('L');
  return ends[thick[n][0]==k?0:1].split(',').map(Number)};
const centres=()=>d.list.wheels.map(w=>place(w.centre));
const drag=(x,y)=>{const at=(e,t,x,y)=>e.dispatchEvent(
  new PointerEvent(t,{pointerId:1,clientX:x,clientY:y,bubbles:true}));
  at(svg,'pointerdown',200,200);at(window,'pointermove',200+x,200+y);
  at(window,'pointerup',200+x,200+y);at(window,'pointermove',0,0)};
const key=k=>svg.dispatchEvent(new KeyboardEvent('keydown',{key:k}));
