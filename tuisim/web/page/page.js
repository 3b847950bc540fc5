// Adapts textual.js of textual-serve: addresses below the secret one, the font, the focus, the session.
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

// Functions that get the terminal as soon as there is one.
const terminalUsers = [];

// Returns what is sent to the app, with the ctrl key that a finger holds.
let holdCtrl = (data) => data;

// Connects the terminal once more; what has come of a sequence is dropped.
let connect = null;

// textual.js keeps its terminal to itself: it is the first that is set under this name.
Object.defineProperty(Object.prototype, "terminal", {
  configurable: true,
  set(terminal) {
    delete Object.prototype.terminal;
    this.terminal = terminal;
    const again = () => {
      terminal.reset();
      this.connect();
    };
    connect = () => terminal.write("\x18", again);
    for (const use of terminalUsers) use(terminal);
  },
});

// Of its ways to draw, the canvas has cells of whole pixels and is loaded last. Where there is no WebGL, loading that
// stops what comes after it, and what is left has cells of broken pixels.
terminalUsers.push((terminal) => {
  const load = terminal.loadAddon.bind(terminal);
  terminal.loadAddon = (addon) => "onContextLoss" in addon || load(addon);
});

// The canvas of the text has the browser's ratio of pixels, as the pictures have: a box in pixels of the device leaves the
// ratio out where a device is emulated.
delete ResizeObserverEntry.prototype.devicePixelContentBoxSize;

let socket = null;
const say = (...words) => socket?.send(JSON.stringify(words));

const Socket = window.WebSocket;
window.WebSocket = class extends Socket {
  constructor(url) {
    super(session.address(url));
    socket = this;
    session.watch(this);
    const focus = () => session.framed || document.querySelector(".xterm-helper-textarea").focus();
    this.addEventListener("message", focus, { once: true });
    this.addEventListener("message", (event) => session.heard(event.data));
    this.addEventListener("close", session.closed);
  }

  // The terminal speaks on after its app has ended.
  send(data) {
    if (this.readyState === Socket.OPEN) super.send(holdCtrl(data));
  }
};

const start = window.onload;
window.onload = async (event) => {
  document.getElementById("again").addEventListener("click", () => location.reload());
  document.getElementById("terminal").dataset.sessionWebsocketUrl = here.replace(/^http/, "ws") + "ws";
  // The terminal measures its cells once.
  const fonts = ["", "bold ", "italic "].map((style) => document.fonts.load(`${style}16px "Roboto Mono"`));
  await Promise.allSettled([...fonts, document.fonts.load('16px "Monaco"', "⏎")]);
  await session.ready();
  start(event);
};
