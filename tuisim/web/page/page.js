// Adapts textual.js of textual-serve: addresses below the secret one, the font, the focus, and why a session has ended.
"use strict";

const here = location.origin + location.pathname;

// Its downloads are at the top of the server.
const open = window.open.bind(window);
window.open = (url, ...more) => open(String(url).replace(`${location.origin}/download/`, `${here}download/`), ...more);

const Socket = window.WebSocket;
window.WebSocket = class extends Socket {
  constructor(...how) {
    super(...how);
    this.addEventListener("message", () => document.querySelector(".xterm-helper-textarea").focus(), { once: true });
    this.addEventListener("close", (event) => {
      const usual = event.wasClean ? "The session has ended." : "The connection to the server is lost.";
      document.getElementById("reason").textContent = event.reason || usual;
      // textual.js shows the dialog when it hears of the end, after this.
      setTimeout(() => document.getElementById("again").focus());
    });
    // The place must be free before this page is asked for again.
    window.addEventListener("beforeunload", () => this.close());
  }
};

const start = window.onload;
window.onload = async (event) => {
  document.getElementById("again").addEventListener("click", () => location.reload());
  document.getElementById("terminal").dataset.sessionWebsocketUrl = here.replace(/^http/, "ws") + "ws";
  // The terminal measures its cells once.
  await Promise.allSettled(["", "bold ", "italic "].map((style) => document.fonts.load(`${style}16px "Roboto Mono"`)));
  start(event);
};
