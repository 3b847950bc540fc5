// Adapts textual.js of textual-serve: addresses below the secret one, the font, the focus, and why a session has ended.
"use strict";

const here = location.origin + location.pathname;

// It opens a tab for a download, at the top of the server.
const open = window.open.bind(window);
window.open = (url, ...more) => {
  const download = String(url).split(`${location.origin}/download/`)[1];
  if (!download) return open(url, ...more);
  const link = document.createElement("a");
  link.href = `${here}download/${download}`;
  link.download = "";
  link.click();
};

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
  const fonts = ["", "bold ", "italic "].map((style) => document.fonts.load(`${style}16px "Roboto Mono"`));
  await Promise.allSettled([...fonts, document.fonts.load('16px "Monaco"', "⏎")]);
  start(event);
};
