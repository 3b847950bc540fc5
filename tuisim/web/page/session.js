// Keeps the session of a tab: finds its app again after a reload or a lost line, and asks where there is a choice.
"use strict";

const session = (() => {
  const top = location.origin + location.pathname;
  const framed = window.parent !== window;
  const kept = sessionStorage;
  const [LOST, TAKEN_OVER] = [1006, 4001];
  let chosen = "";

  const list = async () => {
    const answer = await fetch(`${top}sessions`);
    return answer.json();
  };

  const ago = (seconds) => (seconds < 90 ? `${seconds} s` : `${Math.round(seconds / 60)} min`);

  const button = (words, act) => {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = words;
    made.addEventListener("click", act);
    return made;
  };

  // Asks which app to show; returns its id, empty for another one.
  const ask = () =>
    new Promise((answer) => {
      const dialog = document.querySelector(".dialog.choice");
      const done = (id) => {
        dialog.classList.remove("-open");
        answer(id);
      };
      const show = (found) => {
        if (!found.sessions.length) return done("");
        const rows = found.sessions.map((one) => {
          const row = document.createElement("p");
          const name = document.createElement("strong");
          name.textContent = one.program || "No program";
          const where = one.shown ? "open in another tab" : "not open anywhere";
          const times = `started ${ago(one.age_s)} ago, last used ${ago(one.idle_s)} ago`;
          row.append(name, `${one.runs ? ", running" : ""}, ${times}, ${where} `);
          row.append(button(one.shown ? "Take over" : "Go on", () => done(one.id)), " ");
          row.append(
            button("End it", async () => {
              await fetch(`${top}sessions/${one.id}/end`, { method: "POST" });
              // It is listed until it has ended.
              const left = async () => {
                const now = await list();
                now.sessions.some((other) => other.id === one.id) ? setTimeout(left, 100) : show(now);
              };
              left();
            }),
          );
          return row;
        });
        const last = document.createElement("p");
        if (found.free > 0) last.append(button("Start another one", () => done("")));
        // A student has one app.
        else if (found.most > 1) last.append("No place is free for another one.");
        const head = document.createElement("h1");
        head.textContent = found.most > 1 ? "Which app?" : "Your app is there already";
        dialog.replaceChildren(head, ...rows, last);
        dialog.classList.add("-open");
        dialog.querySelector("button").focus();
      };
      list().then(show);
    });

  // A copy of a tab has its storage, too: only what this tab has just left is its own without a question.
  const find = async () => {
    const [id, leaving] = [kept.getItem("session"), kept.getItem("leaving")];
    kept.removeItem("leaving");
    const { sessions: found, free } = await list();
    const mine = found.find((one) => one.id === id && (leaving || !one.shown));
    if (mine) return mine.id;
    if (framed && found.length) return found[0].id;
    // Where there is no choice: a student has one app.
    if (found.length === 1 && !found[0].shown && free < 1) return found[0].id;
    return found.length ? ask() : "";
  };

  window.addEventListener("pagehide", () => kept.setItem("leaving", "1"));

  const say = (words) => (document.getElementById("reason").textContent = words);

  const again = async () => {
    document.body.classList.add("-closed");
    document.getElementById("again").hidden = true;
    say("The connection to the server is lost. Trying again …");
    try {
      const answer = await fetch(`${top}sessions`);
      answer.ok ? location.reload() : say(await answer.text());
    } catch {
      setTimeout(again, 1000);
    }
  };

  return {
    // Resolves once it is known which app to show.
    ready: async () => {
      try {
        chosen = await find();
      } catch {
        again();
        await new Promise(() => {});
      }
    },
    // Adds the app to the address of a socket.
    address: (url) => (chosen ? `${url}&session=${chosen}` : url),
    heard: (data) => {
      if (typeof data !== "string") return;
      const [what, told] = JSON.parse(data);
      if (what === "watched") document.getElementById("watched").hidden = !told;
      if (what === "panels") {
        for (const button of document.querySelectorAll("[data-act^=panel-]:not([data-act=panel-next])")) {
          button.setAttribute("aria-pressed", String(told.includes(button.dataset.act.slice("panel-".length))));
        }
      }
      if (what !== "session") return;
      chosen = told;
      kept.setItem("session", chosen);
    },
    closed: (event) => {
      if (event.code === LOST) return again();
      say(event.reason || "The session has ended.");
      const button = document.getElementById("again");
      button.textContent = event.code === TAKEN_OVER ? "Take it back" : "Start again";
      // textual.js shows the dialog when it hears of the end, after this.
      setTimeout(() => button.focus());
    },
    drop: async (file) => {
      const name = encodeURIComponent(file.name);
      const answer = await fetch(`${top}sessions/${chosen}/file?name=${name}`, { method: "POST", body: file });
      if (!answer.ok) alert(`${file.name}: ${await answer.text()}`);
    },
    framed,
  };
})();

if (session.framed) {
  // As large as the text around the frame.
  document.addEventListener("DOMContentLoaded", () => (document.getElementById("terminal").dataset.fontSize = "13"));
}

if (session.framed) {
  // Until somebody has clicked into the app, the mouse wheel scrolls what is around the frame.
  const scroll = (event) => document.hasFocus() || event.stopImmediatePropagation();
  window.addEventListener("wheel", scroll, { capture: true });
}

// The cell of a notebook waits for this, in case the address does not lead here.
if (session.framed) window.parent.postMessage("tuisim", "*");

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  event.preventDefault();
  for (const file of event.dataTransfer.files) session.drop(file);
});
