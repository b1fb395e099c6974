// Searches the list of all names. Without scripts the list is there, for the browser's own search.
const all = [...document.querySelectorAll("#names li")];
const box = document.querySelector("#search");
const found = document.querySelector("#found");
const show = () => {
  const words = box.querySelector("input").value.toLowerCase().split(/\s+/).filter(Boolean);
  const hits = words.length ? all.filter((row) => words.every((word) => row.textContent.toLowerCase().includes(word))) : [];
  found.replaceChildren(...hits.slice(0, 40).map((row) => row.cloneNode(true)));
  box.querySelector("span").textContent = words.length ? `${hits.length} found${hits.length > 40 ? ", the first 40 below" : ""}` : "";
};
box.hidden = false;
box.addEventListener("input", show);
show();
