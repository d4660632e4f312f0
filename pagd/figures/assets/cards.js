// ---- cards: what there is of one design, read from its own file when it is opened ---------------

// By name: the promise of what the file of a design holds, and how to keep it.
const files = new Map();

// Each file calls this with what it holds.
function takeCard(data) {
  const file = files.get(data.name);
  if (!file) return;
  file.isRead = true;
  file.resolve(data);
}

function cardOf(name) {
  return document.getElementById("design-" + name);
}

// What the file of a design holds; rejected where the file is not beside the page.
function loadCard(name) {
  if (!files.has(name)) {
    const file = {};
    file.promise = new Promise((resolve, reject) => Object.assign(file, { resolve, reject }));
    files.set(name, file);
    const script = document.createElement("script");
    script.src = cardOf(name).dataset.address + "/card.js";
    // Nothing comes of a promise that is kept; whoever asks once more has the file read once more.
    const fail = () => {
      if (!file.isRead) files.delete(name);
      file.reject(new Error(`${script.getAttribute("src")} cannot be read: it must lie beside this page.`));
      script.remove();
    };
    script.addEventListener("error", fail);
    script.addEventListener("load", fail);
    document.head.append(script);
  }
  return files.get(name).promise;
}

function designOf(name) {
  return content.designs.find((design) => design.name === name);
}

function copyOf(template) {
  return document.getElementById(template).content.cloneNode(true);
}

async function fillCard(card) {
  if (card.dataset.filled) return;
  card.dataset.filled = "yes";
  const name = card.id.slice("design-".length);
  const body = card.querySelector(":scope > div") || document.createElement("div");
  body.innerHTML = '<p class="note">Loading …</p>';
  card.append(body);
  try {
    const data = await loadCard(name);
    body.innerHTML = data.markup;
    showCard(body, designOf(name), data, card.dataset.address);
  } catch (error) {
    body.innerHTML = '<p class="reason"></p>';
    body.firstChild.textContent = error.message;
    delete card.dataset.filled;
  }
}

function showCard(body, design, data, address) {
  for (const link of body.querySelectorAll("a[download]")) {
    link.setAttribute("href", `${address}/${link.getAttribute("href")}`);
  }
  const place = body.querySelector(".place");
  if (data.shape) {
    place.append(copyOf("bench"));
    place.querySelector(".turn").append(copyOf("shape"));
    new Viewer(place, design, data);
  }
  const curves = document.createElement("div");
  curves.className = "curves";
  place.append(curves);
  drawSteps(curves, data.steps);
}

function openCard(name) {
  const card = cardOf(name);
  if (!card) return;
  card.open = true;
  card.scrollIntoView();
}

// The name in a link to a design; what nobody has encoded is taken as it is.
function nameIn(hash) {
  const text = hash.slice("#design-".length);
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

// Links to a design lead to its card, and open it.
function followLinks() {
  const follow = () => {
    if (location.hash.startsWith("#design-")) openCard(nameIn(location.hash));
  };
  addEventListener("hashchange", follow);
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#design-"]');
    if (link && link.hash === location.hash) follow();
  });
  follow();
}

function prepareCards() {
  for (const card of document.querySelectorAll(".card")) {
    card.addEventListener("toggle", () => card.open && fillCard(card));
    if (card.open) fillCard(card);
  }
}
