// The theme puts the copy button of every block into a landmark without a name; a button alone needs none.
// A wide table scrolls sideways, which a keyboard has to reach.
const plain = () => {
  for (const bar of document.querySelectorAll("nav.md-code__nav:not([role])")) bar.setAttribute("role", "none");
  for (const box of document.querySelectorAll(".md-typeset__scrollwrap:not([tabindex])")) box.tabIndex = 0;
};
new MutationObserver(plain).observe(document.body, { childList: true, subtree: true });
plain();
