// Beside the report the contents stay open, above it they are a fold that keeps what its reader chose.
const contents = document.querySelector("details.contents"), list = contents.querySelector("nav");
{
  const beside = matchMedia("(min-width: 75rem)");
  let chosen = false, arranged = false;
  const arrange = () => {
    contents.open = arranged = beside.matches || chosen;
    if (beside.matches) list.tabIndex = 0;
    else list.removeAttribute("tabindex");
    contents.classList.add("arranged");
  };
  // The event of a toggle comes late, perhaps after the window has changed: a reader's click counts at once, and what arrange did never does.
  contents.querySelector("summary").addEventListener("click", () => { if (!beside.matches) chosen = !contents.open; });
  contents.addEventListener("toggle", () => { if (!beside.matches && contents.open !== arranged) chosen = contents.open; });
  beside.addEventListener("change", arrange);
  arrange();
}

// The entry of the contents whose section stands in the upper part of the window.
{
  const entries = new Map([...list.querySelectorAll("a")].map(a => [document.getElementById(a.hash.slice(1)), a]));
  entries.delete(null);
  const seen = new Set();
  let marked = null;

  const mark = entry => {
    if (entry === marked) return;
    marked?.removeAttribute("aria-current");
    entry?.setAttribute("aria-current", "location");
    marked = entry;
    const room = list.getBoundingClientRect();
    if (!entry || list.scrollHeight <= list.clientHeight) return;
    const {top, bottom} = entry.getBoundingClientRect();
    if (top < room.top + 40 || bottom > room.bottom - 40) list.scrollTop += (top + bottom - room.top - room.bottom) / 2;
  };

  // Sections stand in each other: the innermost one comes last in the document.
  const watch = new IntersectionObserver(changes => {
    for (const {target, isIntersecting} of changes) seen[isIntersecting ? "add" : "delete"](target);
    mark([...entries].filter(([section]) => seen.has(section)).at(-1)?.[1] ?? null);
  }, {rootMargin: "-8% 0px -72% 0px"});
  for (const section of entries.keys()) watch.observe(section);

  const up = document.querySelector(".up");
  new IntersectionObserver(([{isIntersecting}]) => { up.hidden = isIntersecting; }).observe(document.getElementById("top"));
}

// On a phone every row of a table that is wider than the page is a block of its own, which names its cells. A long table scrolls.
{
  const MOST = 64, phone = matchMedia("(max-width: 45rem)");
  const boxes = [...document.querySelectorAll(".scroll")].filter(b => b.querySelector("table")?.tBodies[0].rows.length <= MOST);
  const roles = {THEAD: "rowgroup", TBODY: "rowgroup", TR: "row", TH: "columnheader", TD: "cell"};
  const named = table => {
    if (table.hasAttribute("role")) return;
    table.setAttribute("role", "table");
    for (const e of table.querySelectorAll("thead, tbody, tr, th, td")) e.setAttribute("role", roles[e.tagName]);
    const names = [...table.tHead.rows[0].cells].map(c => c.textContent.trim());
    for (const {cells} of table.tBodies[0].rows) [...cells].forEach((c, i) => { if (i && names[i]) c.dataset.name = names[i]; });
  };
  const stack = () => {
    for (const b of boxes) b.classList.remove("stacked");
    if (!phone.matches) return;
    const wide = boxes.filter(b => b.scrollWidth > b.clientWidth + 1);
    for (const b of wide) { named(b.querySelector("table")); b.classList.add("stacked"); }
  };
  let asked = 0;  // many folds that open at once are looked at once
  const soon = () => { asked ||= requestAnimationFrame(() => { asked = 0; stack(); }); };
  phone.addEventListener("change", stack);
  let width = innerWidth;
  addEventListener("resize", () => { if (phone.matches && innerWidth !== width) soon(); width = innerWidth; });
  for (const fold of document.querySelectorAll(".fold")) fold.addEventListener("toggle", soon);
  stack();
}
