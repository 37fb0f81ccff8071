// The wheel centres at each point of the first branch.
press('Front');
const seen={wrong,branch:d.branches[0].name,a:d.branches[0].a,at:[],
  marks:document.querySelectorAll('.here[d^=M]').length};
d.branches[0].a.forEach((a,k)=>{slide(k);seen.at.push([shown(),...centres().map(p=>p[1])])});
const [l,r]=d.list.wheels.map(w=>w.centre),last=d.branches[0].d.at(-1);
const y=k=>d.points[3*k+1]+last[3*k+1];
seen.px_per_mm=(centres()[0][0]-centres()[1][0])/(y(l)-y(r))*100;
