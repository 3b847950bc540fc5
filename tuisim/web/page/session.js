// Keeps the session of a tab: finds its app again after a reload or a lost line, and asks where there is a choice.
"use strict";

// A frame in a page of another site may have no storage: then nothing is kept.
const findStorage = () => {
  try {
    return sessionStorage;
  } catch {
    return { getItem: () => null, setItem: () => {}, removeItem: () => {} };
  }
};

const session = (() => {
  const top = location.origin + location.pathname;
  const framed = window.parent !== window;
  const kept = findStorage();
  const [LOST, TAKEN_OVER, REFUSED] = [1006, 4001, 403];
  // A line that says nothing for so long is asked, and has so long to answer; a request, too.
  const [SILENT_MS, ANSWER_MS, RETRY_MS] = [10000, 10000, 1000];
  const ENDED = "The session has ended.";
  let chosen = "";
  let [current, since, answered, drawn] = [null, 0, true, false];

  const pause = (ms) => new Promise((over) => setTimeout(over, ms));

  const say = (words) => {
    document.getElementById("reason").textContent = words;
    document.body.classList.add("-closed");
  };

  // Tells the cell of a notebook that shows the page: it is here, the app is open, or closed and why.
  const tell = (...said) => framed && window.parent.postMessage({ tuisim: said }, "*");

  // Says why there is no app; only a cell of the notebook can start another one there.
  const end = (words, button) => {
    const again = document.getElementById("again");
    again.hidden = framed;
    again.textContent = button;
    say(words);
    tell("closed", words);
    // textual.js shows the dialog when it hears of the end, after this.
    setTimeout(() => again.focus());
  };

  // Whoever may not have the list tries in vain.
  const list = async () => {
    const answer = await fetch(`${top}sessions`, { signal: AbortSignal.timeout(ANSWER_MS) });
    if (answer.ok) return answer.json();
    if (answer.status !== REFUSED) throw new Error(answer.statusText);
    document.getElementById("again").hidden = true;
    say(await answer.text());
    tell("closed", "Another cell shows the app now.");
    return new Promise(() => {});
  };

  const sayLost = () => {
    document.getElementById("again").hidden = true;
    const more = framed ? " If the kernel has ended, run the cell again." : "";
    say(`The connection to the server is lost. Trying again …${more}`);
  };

  // Does something as soon as the server answers.
  const insist = async (act) => {
    for (;;) {
      try {
        const result = await act();
        document.body.classList.remove("-closed");
        return result;
      } catch {
        sayLost();
        await pause(RETRY_MS);
      }
    }
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
    new Promise((answer, fail) => {
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
        else last.append("The server has no room for another app.");
        const head = document.createElement("h1");
        head.textContent = "Which app?";
        dialog.replaceChildren(head, ...rows, last);
        dialog.classList.add("-open");
        dialog.querySelector("button").focus();
      };
      list().then(show).catch(fail);
    });

  // A copy of a tab has its storage, too: only what this tab has just left is its own without a question.
  const find = async () => {
    const [id, leaving] = [kept.getItem("session"), kept.getItem("leaving")];
    kept.removeItem("leaving");
    const { sessions: found, free } = await list();
    const mine = found.find((one) => one.id === id && (leaving || !one.shown));
    if (mine) return mine.id;
    if (framed && found.length) return found[0].id;
    // Where there is no choice.
    if (found.length === 1 && !found[0].shown && free < 1) return found[0].id;
    return found.length ? ask() : "";
  };

  window.addEventListener("pagehide", () => kept.setItem("leaving", "1"));

  // Shows the same app again, on another line.
  const again = async () => {
    sayLost();
    await pause(since + RETRY_MS - Date.now());
    if (!chosen) {
      // The line was lost before it told the session.
      await insist(list);
      return location.reload();
    }
    // A socket does not tell that it is refused.
    if (!answered) await list().catch(() => {});
    connect();
  };

  const lost = (socket) => {
    if (socket !== current) return;
    current = null;
    socket.close();
    again();
  };

  return {
    // Resolves once it is known which app to show.
    ready: async () => {
      chosen = await insist(find);
      if (!framed || chosen) return;
      end(ENDED);
      await new Promise(() => {});
    },
    // Leaves a line that is dead, though nobody has said so.
    watch: (socket) => {
      [current, since, answered] = [socket, Date.now(), false];
      let [heard, asked] = [since, 0];
      socket.addEventListener("message", (event) => {
        [heard, asked, answered] = [Date.now(), 0, true];
        if (String(event.data).startsWith('["pong"')) event.stopImmediatePropagation();
      });
      const timer = setInterval(() => {
        if (socket !== current) return clearInterval(timer);
        if (asked ? Date.now() - asked < ANSWER_MS : Date.now() - heard < SILENT_MS) return;
        if (asked || socket.readyState !== WebSocket.OPEN) return lost(socket);
        asked = Date.now();
        socket.send(JSON.stringify(["ping", ""]));
      }, RETRY_MS);
    },
    // Adds the app to the address of a socket.
    address: (url) => (chosen ? `${url}&session=${chosen}` : url),
    heard: (data) => {
      if (typeof data !== "string") {
        // What the app draws.
        if (!drawn) tell("open");
        drawn = true;
        return;
      }
      const [what, told] = JSON.parse(data);
      if (what === "panels") {
        for (const button of document.querySelectorAll("[data-act^=panel-]:not([data-act=panel-next])")) {
          button.setAttribute("aria-pressed", String(told.includes(button.dataset.act.slice("panel-".length))));
        }
      }
      if (what !== "session") return;
      chosen = told;
      document.body.classList.remove("-closed");
      kept.setItem("session", chosen);
    },
    closed: (event) => {
      // textual.js would show that it is closed.
      if (event.target !== current || event.code === LOST) event.stopImmediatePropagation();
      if (event.target !== current) return;
      if (event.code === LOST) return lost(event.target);
      current = null;
      const isTaken = event.code === TAKEN_OVER;
      const taken = framed ? "Another cell or tab shows the app now." : event.reason;
      end(isTaken ? taken : event.reason || ENDED, isTaken ? "Take it back" : "Start again");
    },
    drop: async (file) => {
      const name = encodeURIComponent(file.name);
      const answer = await fetch(`${top}sessions/${chosen}/file?name=${name}`, { method: "POST", body: file });
      if (!answer.ok) alert(`${file.name}: ${await answer.text()}`);
    },
    framed,
    tell,
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
session.tell("here");

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  event.preventDefault();
  for (const file of event.dataTransfer.files) session.drop(file);
});
