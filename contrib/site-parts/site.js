// The button for light and dark, the search over all pages, and the filter of the parameters. Works from files, without a server.
"use strict";
const root = document.currentScript.dataset.root;

try { const kept = localStorage.getItem("theme"); if (kept) document.documentElement.dataset.theme = kept; } catch { /* no storage for files */ }
document.getElementById("theme").addEventListener("click", () => {
  const html = document.documentElement;
  const dark = html.dataset.theme ? html.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  html.dataset.theme = dark ? "light" : "dark";
  try { localStorage.setItem("theme", html.dataset.theme); } catch { /* likewise */ }
});

const words = text => text.toLowerCase().split(/\s+/).filter(Boolean);

// --- search: every word must be there; words in titles count more
const box = document.getElementById("search"), found = document.getElementById("found");
let loading = null;
function load() {
  return loading ??= new Promise((done, failed) => {
    const script = document.createElement("script");
    script.src = root + "search-index.js";
    script.onload = done;
    script.onerror = failed;
    document.head.append(script);
  });
}
function around(text, word) {
  const at = Math.max(0, text.toLowerCase().indexOf(word) - 40);
  return (at > 0 ? "…" : "") + text.slice(at, at + 150) + (at + 150 < text.length ? "…" : "");
}
async function search() {
  const wanted = words(box.value);
  if (wanted.join("").length < 2) { found.hidden = true; return; }
  await load();
  const hits = [];
  for (const [title, url, text] of searchIndex) {
    const head = title.toLowerCase(), body = text.toLowerCase();
    if (!wanted.every(w => head.includes(w) || body.includes(w))) continue;
    hits.push([wanted.reduce((sum, w) => sum + (head.includes(w) ? 10 : 0) + Math.min(3, body.split(w).length - 1), 0) - head.length / 100, title, url, text]);
  }
  hits.sort((a, b) => b[0] - a[0]);
  found.replaceChildren(...hits.slice(0, 30).map(([, title, url, text]) => {
    const link = document.createElement("a"), small = document.createElement("small");
    link.href = root + url;
    link.append(title, small);
    small.textContent = around(text, wanted[0]);
    return link;
  }));
  if (!hits.length) found.innerHTML = "<p>Nothing has all of these words.</p>";
  found.hidden = false;
}
box.addEventListener("input", search);
box.addEventListener("keydown", event => {
  const links = [...found.querySelectorAll("a")], at = links.findIndex(link => link.classList.contains("at"));
  if (event.key === "Escape") { found.hidden = true; box.blur(); }
  else if (event.key === "Enter" && links.length) links[Math.max(at, 0)].click();
  else if (["ArrowDown", "ArrowUp"].includes(event.key) && links.length) {
    event.preventDefault();
    links[at]?.classList.remove("at");
    const next = links[(at + (event.key === "ArrowDown" ? 1 : links.length - 1) + (at < 0 && event.key === "ArrowUp" ? 1 : 0)) % links.length];
    next.classList.add("at");
    next.scrollIntoView({ block: "nearest" });
  }
});
document.addEventListener("click", event => { if (!event.target.closest("header")) found.hidden = true; });
document.addEventListener("keydown", event => {
  if (event.key === "/" && !event.target.closest("input")) { event.preventDefault(); box.focus(); }
});

// --- parameters: only those with all words; headings of what is hidden go, too
const filter = document.getElementById("filter");
if (filter) {
  const parts = [...document.querySelectorAll("main > h2, main > h3, main > .parameter")];
  let heading2 = "", heading3 = "";
  const texts = parts.map(part => {
    if (part.tagName === "H2") { heading2 = part.textContent; heading3 = ""; }
    else if (part.tagName === "H3") heading3 = part.textContent;
    return (heading2 + " " + heading3 + " " + part.textContent).toLowerCase();
  });
  filter.addEventListener("input", () => {
    const wanted = words(filter.value);
    let shown = 0, last2 = null, last3 = null;
    parts.forEach((part, i) => {
      if (part.tagName === "H2") { last2 = part; last3 = null; part.hidden = wanted.length > 0; }
      else if (part.tagName === "H3") { last3 = part; part.hidden = wanted.length > 0; }
      else {
        part.hidden = !wanted.every(w => texts[i].includes(w));
        if (!part.hidden) { shown += 1; if (last2) last2.hidden = false; if (last3) last3.hidden = false; }
      }
    });
    document.getElementById("count").textContent = wanted.length ? shown + " shown" : "";
  });
}
