// The tutor's page: a row for each student, asked for again every two seconds.
"use strict";

const EVERY_MS = 2000;
const top_ = location.origin + location.pathname;
const rows = new Map();
const ENDS = { raised: "error" };

const span = (seconds) => {
  if (seconds < 90) return `${seconds} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
};

const counted = (number, noun) => `${number} ${noun}${number === 1 ? "" : "s"}`;

const state = (app) => {
  if (app.runs) return `runs for ${span(app.since_s)}`;
  if (app.end) return `${(ENDS[app.end] || app.end).replaceAll("_", " ")} ${span(app.since_s)} ago`;
  return app.program ? "not run yet" : "";
};

// The texts of a row, after the name.
const texts = (app) =>
  app
    ? [
        app.shown ? "open" : "closed",
        app.program || "none",
        state(app),
        `${span(app.age_s)} ago`,
        `${span(app.idle_s)} ago`,
        app.memory_mb ? `${app.memory_mb} MB` : "",
      ]
    : ["no app", "", "", "", "", ""];

const heads = [...document.querySelectorAll("th")].map((head) => head.textContent.trim());

const button = (words, label, act) => {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = words;
  made.setAttribute("aria-label", label);
  made.addEventListener("click", () => act(made));
  return made;
};

// A browser gives the clipboard to pages of this machine, and of addresses with encryption, only.
const copyLink = async (name, made) => {
  const answer = await fetch(`${top_}students/${encodeURIComponent(name)}/link`, { method: "POST" });
  if (!answer.ok) return alert(await answer.text());
  const link = new URL(`../${(await answer.json()).token}/`, top_).href;
  try {
    await navigator.clipboard.writeText(link);
    made.textContent = "Copied";
    setTimeout(() => (made.textContent = "Copy link"), EVERY_MS);
  } catch {
    prompt(`The link of ${name}:`, link);
  }
};

const end = async (name) => {
  if (!confirm(`End the app of ${name}? A program that runs stops; what is saved stays.`)) return;
  const answer = await fetch(`${top_}students/${encodeURIComponent(name)}/end`, { method: "POST" });
  if (!answer.ok) alert(await answer.text());
};

const rowOf = (name) => {
  if (rows.has(name)) return rows.get(name);
  const row = document.createElement("tr");
  const first = document.createElement("th");
  first.scope = "row";
  first.textContent = name;
  row.append(first);
  for (const head of heads.slice(1, -1)) {
    const cell = document.createElement("td");
    cell.dataset.head = head;
    row.append(cell);
  }
  const look = document.createElement("td");
  const link = document.createElement("a");
  link.href = `${top_}view/${encodeURIComponent(name)}/`;
  link.textContent = "Look on";
  link.setAttribute("aria-label", `Look on at ${name}`);
  look.append(
    link,
    button("Copy link", `Copy the link of ${name}`, (made) => copyLink(name, made)),
    button("End", `End the app of ${name}`, () => end(name)),
  );
  row.append(look);
  document.getElementById("students").append(row);
  rows.set(name, row);
  return row;
};

const show = ({ students }) => {
  for (const { name, app } of students) {
    const row = rowOf(name);
    row.className = app ? (app.runs ? "runs" : "rests") : "none";
    texts(app).forEach((text, at) => {
      row.children[at + 1].textContent = text;
    });
    for (const only of [row.querySelector("a"), row.querySelector("button:last-child")]) only.hidden = !app;
  }
  const apps = students.map((one) => one.app).filter(Boolean);
  const shown = apps.filter((app) => app.shown).length;
  const running = apps.filter((app) => app.runs).length;
  const counts = [counted(students.length, "student"), `${shown} with an open tab`, counted(apps.length, "app")];
  document.getElementById("sum").textContent = [...counts, `${counted(running, "program")} running`].join(", ");
};

const ask = async () => {
  try {
    const answer = await fetch(`${top_}students`);
    if (!answer.ok) throw new Error(await answer.text());
    show(await answer.json());
    document.body.classList.remove("lost");
  } catch (error) {
    document.body.classList.add("lost");
    document.getElementById("sum").textContent = `The server does not answer: ${error.message}`;
  }
  setTimeout(ask, EVERY_MS);
};

ask();
