// The drawings and controls of a page without scripts.
const views=[...document.querySelectorAll(
  'section[id$=first] .plot svg,section[id$=drawing] .plot svg')];
const seen={wrong,views:views.map(s=>s.getBoundingClientRect().height),
  controls:document.querySelectorAll('button,select,input,.turn').length};
