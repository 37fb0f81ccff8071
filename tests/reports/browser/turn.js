// The wheel centres seen from the front, dragged, turned by a key, from the top, and nearer.
const seen={wrong,requests:performance.getEntriesByType('resource').length,
  hidden:getComputedStyle(fixed).display};
press('Front');seen.front=centres();
drag(60,0);seen.dragged=centres();drag(-60,0);seen.back=centres();
key('ArrowRight');seen.key=centres();press('Top');seen.top=centres();press('+');seen.near=centres();
seen.focus=svg.tabIndex;seen.buttons=buttons().map(b=>b.ariaLabel);
