// The tutor's page: a row for each student, asked for again every two seconds.
"use strict";

const EVERY_MS = 2000;
const top_ = location.origin + location.pathname;
const rows = new Map();

const span = (seconds) => {
  if (seconds < 90) return `${seconds} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
};

const counted = (number, noun) => `${number} ${noun}${number === 1 ? "" : "s"}`;

const state = (app) => {
  if (app.runs) return `runs for ${span(app.since_s)}`;
  return app.program ? `at rest for ${span(app.since_s)}` : "";
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
  look.append(link);
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
    row.querySelector("a").hidden = !app;
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
