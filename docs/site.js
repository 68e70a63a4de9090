// The theme puts the copy button of every block into a landmark without a name; a button alone needs none.
const plain = () => { for (const bar of document.querySelectorAll("nav.md-code__nav:not([role])")) bar.setAttribute("role", "none"); };
new MutationObserver(plain).observe(document.body, { childList: true, subtree: true });
plain();
