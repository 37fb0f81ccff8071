// Heights and right ends of the rows of rates.
const rows=[...document.querySelectorAll('section[id$=rates] tr,section[id$=first] tr')];
const cells=[...document.querySelectorAll('section[id$=rates] td')];
const seen={rows:rows.length,tallest:Math.max(...rows.map(r=>r.getBoundingClientRect().height)),
  right:Math.max(...cells.map(c=>c.getBoundingClientRect().right)),window:innerWidth};
