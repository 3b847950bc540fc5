// Looks on at an app: as many columns and rows as it has, in text as large as fits. The server ignores what is sent.
"use strict";

const session = {
  framed: true,
  ready: async () => {
    const name = decodeURIComponent(location.pathname.split("/").at(-2));
    document.getElementById("name").textContent = name;
    document.title = `${name} · tuisim`;
  },
  address: (url) => url,
  watch: () => {},
  heard: (data) => {
    if (typeof data !== "string") return;
    const [what, size] = JSON.parse(data);
    if (what === "size") view.resize(...size);
  },
  closed: (event) => {
    const reason = event.reason || (event.code === 1006 ? "The connection is lost." : "The session has ended.");
    document.getElementById("reason").textContent = reason;
    // A page that has got no picture yet says this, too.
    setTimeout(() => document.body.classList.add("-closed"));
  },
};

class View {
  use(terminal) {
    this.terminal = terminal;
    terminal.options.disableStdin = true;
    // A program of the student must not reach the clipboard of who looks on.
    terminal.parser.registerOscHandler(52, () => true);
    this.setSize = terminal.resize.bind(terminal);
    // The page of the app fits its terminal into the window.
    terminal.resize = () => {};
    window.addEventListener("resize", () => this.fit());
  }

  resize(columns, rows) {
    this.size = [columns, rows];
    this.setSize(columns, rows);
    this.fit();
  }

  // Roboto Mono is 0.6 times as wide as its size, and 1.32 times as high.
  fit() {
    if (!this.size) return;
    const { clientWidth, clientHeight } = document.getElementById("terminal");
    const [columns, rows] = this.size;
    const px = Math.floor(Math.min(clientWidth / (0.605 * columns), clientHeight / (1.34 * rows)));
    this.terminal.options.fontSize = Math.max(2, px);
  }
}

const view = new View();
document.addEventListener("DOMContentLoaded", () => terminalUsers.push((terminal) => view.use(terminal)));
