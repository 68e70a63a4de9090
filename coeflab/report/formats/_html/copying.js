// Copies hold numbers that other programs read: -1.56e-5, not the characters of good print.
const bare = text => text.replace(/\u2212/g, "-").replace(/\u202f×\u202f10(?:\^|<sup><b>\^<\/b>)(-?\d+)(?:<\/sup>)?/g, "e$1");

document.addEventListener("copy", event => {
  const chosen = document.getSelection();
  if (!chosen || chosen.isCollapsed || !event.clipboardData) return;
  const box = document.createElement("div");
  for (let i = 0; i < chosen.rangeCount; i++) box.append(chosen.getRangeAt(i).cloneContents());
  event.clipboardData.setData("text/plain", bare(String(chosen)));
  event.clipboardData.setData("text/html", bare(box.innerHTML));
  event.preventDefault();
});
