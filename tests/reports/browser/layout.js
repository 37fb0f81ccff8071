// Sizes, clashes, colours and requests of the page.
document.querySelectorAll('details.evidence').forEach(d=>d.open=true);
const boxes=[...document.querySelectorAll('svg')].filter(s=>s.checkVisibility())
  .map(s=>s.getBoundingClientRect()).map(b=>[b.width,b.height]);
const luminance=c=>{const v=c.match(/[\d.]+/g).slice(0,3).map(x=>x/255)
    .map(x=>x<=.04045?x/12.92:((x+.055)/1.055)**2.4);
  return .2126*v[0]+.7152*v[1]+.0722*v[2]};
const paper=luminance(getComputedStyle(document.body).backgroundColor);
const contrast=e=>{const l=luminance(getComputedStyle(e)[e.closest('svg')?'fill':'color']);
  return (Math.max(l,paper)+.05)/(Math.min(l,paper)+.05)};
const words=[...document.querySelectorAll(
  'p,h1,h2,h3,h4,td,th,dt,dd,figcaption,caption,summary,svg text')];
const clashes=[];
for(const s of document.querySelectorAll('svg')){const all=s.getBoundingClientRect(),
  title=s.querySelector('title')?.textContent,
  t=[...s.querySelectorAll('text')].filter(e=>e.textContent.trim())
    .map(e=>[e.textContent.trim(),e.getBoundingClientRect()]);
  t.forEach(([a,p],i)=>{
    if(p.left<all.left-1||p.right>all.right+1||p.top<all.top-1||p.bottom>all.bottom+1)
      clashes.push(a+' leaves '+title);
    t.slice(0,i).forEach(([b,q])=>{
      if(p.left<q.right-.5&&q.left<p.right-.5&&p.top<q.bottom-1.5&&q.top<p.bottom-1.5)
        clashes.push(title+': '+a+' on '+b)})})}
const outside=[...document.querySelectorAll('table,pre,svg,p,dl,h1,h2,h3,h4')]
  .filter(e=>!e.closest('.scroll,pre')&&e.getBoundingClientRect().right>innerWidth+1)
  .map(e=>e.tagName);
const seen={boxes,wrong,clashes,outside,requests:performance.getEntriesByType('resource').length,
  page:document.documentElement.scrollWidth,window:innerWidth,dark:paper<.2,
  contrast:Math.min(...words.map(contrast)),words:words.length};
