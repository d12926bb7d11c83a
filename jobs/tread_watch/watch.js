"use strict";
// Puts a fresh page in the place of the old one every two seconds, while somebody looks.
const title = document.title;

function show(main) {
  const old = document.querySelector("main");
  if (old.innerHTML !== main.innerHTML) old.replaceWith(document.adoptNode(main));
  document.title = main.dataset.title + title;
}

async function refresh() {
  if (document.hidden) return;
  const lost = document.getElementById("lost");
  try {
    const answer = await fetch(location.href);
    const main = new DOMParser().parseFromString(await answer.text(), "text/html").querySelector("main");
    show(main); // an error where the answer has none
    lost.hidden = true;
  } catch {
    lost.hidden = false;
  }
}

show(document.querySelector("main").cloneNode(true));
setInterval(refresh, 2000);
document.addEventListener("visibilitychange", refresh);
