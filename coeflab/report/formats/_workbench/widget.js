// Every cell has names of its own, so that two benches do not share a label.
let benches = 0;
export default { render({ model, el }) {
  const root = document.createElement("div"), inside = document.createElement("div");
  root.className = "bench";
  inside.className = "columns";
  root.append(inside);
  el.append(root);
  return mountBench(inside, JSON.parse(model.get("content")), model.get("numbers"), `bench${benches++}`);
} };
