// Fingers: a bar of buttons, touches as the mouse, swipes as its wheel, and the size of the text.
"use strict";

const [LEAST_TEXT_PX, READABLE_TEXT_PX, USUAL_TEXT_PX, MOST_TEXT_PX] = [6, 10, 16, 40];
// Columns and rows that the app's panels need, and the fewest that it shows.
const [ENOUGH, LEAST] = [
  [64, 24],
  [40, 12],
];
const KEYS = {
  enter: "\r",
  esc: "\x1b",
  tab: "\t",
  left: "\x1b[D",
  up: "\x1b[A",
  down: "\x1b[B",
  right: "\x1b[C",
  wrong: "!",
  second: "<",
  tick: ",",
  end: "\x1b[F",
};
const HOLD_PX = 8;
// Two fingers that are this many times as far apart zoom the world by a step.
const ZOOM_STEP = 1.5;

class Fingers {
  constructor(terminal) {
    this.terminal = terminal;
    this.place = document.getElementById("terminal");
    this.chosenPx = 0;
    this.touch = null;
    terminal.options.fontSize = this.fittingPx();
    for (const kind of ["touchstart", "touchmove", "touchend", "touchcancel"]) {
      this.place.addEventListener(kind, (event) => this[kind](event), { passive: false, capture: true });
    }
    this.prepareBar();
    const first = terminal.onRender(() => {
      first.dispose();
      this.prepareKeyboard();
    });
    // A keyboard on the screen takes its place from the page.
    visualViewport.addEventListener("resize", () => {
      document.body.style.height = `${visualViewport.height}px`;
      this.fit();
    });
  }

  get input() {
    return this.place.querySelector(".xterm-helper-textarea");
  }

  prepareBar() {
    const bar = document.getElementById("bar");
    bar.addEventListener("click", ({ target }) => {
      const { act, key, text } = target.dataset;
      if (act) say("act", act);
      if (key) this.terminal.input(KEYS[key]);
      if (target.id === "ctrl") target.setAttribute("aria-pressed", String(target.ariaPressed !== "true"));
      if (text) this.setText((this.chosenPx || this.terminal.options.fontSize) + Number(text));
      const opens = target.getAttribute("aria-controls");
      for (const menu of bar.querySelectorAll("menu")) {
        if (menu.id === opens) menu.hidden = !menu.hidden;
        else if (opens || act) menu.hidden = true;
      }
      for (const button of bar.querySelectorAll("[aria-controls]")) {
        const menu = document.getElementById(button.getAttribute("aria-controls"));
        button.setAttribute("aria-expanded", String(!menu.hidden));
      }
      this.prepareKeyboard();
      if (opens) this.input.blur();
      this.input.focus();
      this.fit();
    });
  }

  // The keyboard of the screen appears when it is asked for, and not with each touch.
  prepareKeyboard() {
    if (this.isCoarse) this.input.inputMode = document.getElementById("keys").hidden ? "none" : "text";
  }

  get isCoarse() {
    return matchMedia("(pointer: coarse)").matches;
  }

  // The largest text with so many columns and rows: Roboto Mono is 0.6 times as wide as its size, and 1.32 times as high.
  largestPx([cols, rows]) {
    const { clientWidth, clientHeight } = this.place;
    return Math.max(LEAST_TEXT_PX, Math.floor(Math.min(clientWidth / (0.605 * cols), clientHeight / (1.34 * rows))));
  }

  fittingPx() {
    // Above a keyboard, few lines that can be read are better than many.
    const readable = Math.min(READABLE_TEXT_PX, this.largestPx(LEAST));
    return Math.max(readable, Math.min(USUAL_TEXT_PX, this.largestPx(ENOUGH)));
  }

  fit() {
    this.setText(this.chosenPx || this.fittingPx(), Boolean(this.chosenPx));
  }

  setText(px, isChosen = true) {
    const most = Math.min(MOST_TEXT_PX, this.largestPx(LEAST));
    const size = Math.max(LEAST_TEXT_PX, Math.min(most, Math.round(px)));
    if (isChosen) this.chosenPx = size;
    this.terminal.options.fontSize = size;
    window.onresize();
  }

  touchstart(event) {
    event.preventDefault();
    event.stopPropagation();
    const [first, second] = event.touches;
    if (second) {
      if (this.touch?.kind === "drag") this.mouse("mouseup", this.touch);
      const between = { clientX: (first.clientX + second.clientX) / 2, clientY: (first.clientY + second.clientY) / 2 };
      const kind = this.isOnPicture(between) ? "zoom" : "pinch";
      const [x, y] = [between.clientX, between.clientY];
      this.touch = { kind, x, y, apart: apart(first, second), px: this.terminal.options.fontSize };
      return;
    }
    this.touch = { kind: "tap", x: first.clientX, y: first.clientY };
    // A picture is dragged at once; text may be swiped.
    if (this.isOnPicture(first)) this.drag();
  }

  drag() {
    this.touch.kind = "drag";
    this.mouse("mousedown", this.touch);
  }

  touchmove(event) {
    event.preventDefault();
    event.stopPropagation();
    const { touch } = this;
    const [first, second] = event.touches;
    if (touch?.kind === "pinch") {
      // Less than the fingers: a step of the text is a large one.
      const px = second ? touch.px * Math.sqrt(apart(first, second) / touch.apart) : touch.px;
      this.setText(Math.max(px, Math.min(touch.px, READABLE_TEXT_PX)));
      return;
    }
    if (touch?.kind === "zoom") {
      if (second) this.zoom(touch, apart(first, second));
      return;
    }
    if (!touch) return;
    const [x, y] = [first.clientX, first.clientY];
    const [across, down] = [x - touch.x, y - touch.y];
    if (touch.kind === "tap" && Math.hypot(across, down) > HOLD_PX) {
      if (Math.abs(down) > Math.abs(across)) touch.kind = "swipe";
      else this.drag();
    }
    if (touch.kind === "swipe") this.swipe(touch, y);
    if (touch.kind !== "drag") return;
    [touch.x, touch.y] = [x, y];
    this.mouse("mousemove", touch);
  }

  // Turns the wheel with ctrl by a notch for each step.
  zoom(touch, now) {
    const ratio = now / touch.apart;
    if (ratio < ZOOM_STEP && ratio > 1 / ZOOM_STEP) return;
    touch.apart = now;
    const deltaY = ratio > 1 ? -1 : 1;
    this.mouse("wheel", touch, { deltaY, deltaMode: WheelEvent.DOM_DELTA_LINE, ctrlKey: true });
  }

  // Turns the wheel by a notch for each two rows.
  swipe(touch, y) {
    const notch = (2 * this.place.clientHeight) / this.terminal.rows;
    for (const way = Math.sign(touch.y - y); Math.abs(touch.y - y) >= notch; touch.y -= way * notch) {
      this.mouse("wheel", touch, { deltaY: way, deltaMode: WheelEvent.DOM_DELTA_LINE });
    }
  }

  touchend(event) {
    event.preventDefault();
    event.stopPropagation();
    const { touch } = this;
    if (touch?.kind === "tap") this.drag();
    if (touch?.kind === "drag") this.mouse("mouseup", touch);
    // A finger that stays after two does nothing.
    if (!event.touches.length || !["pinch", "zoom"].includes(touch?.kind)) this.touch = null;
    this.input.focus();
  }

  touchcancel(event) {
    this.touchend(event);
  }

  isOnPicture({ clientX, clientY }) {
    const { left, top, width, height } = this.place.querySelector(".xterm-screen").getBoundingClientRect();
    const { rows, cols, buffer } = this.terminal;
    const line = buffer.active.getLine(buffer.active.viewportY + Math.floor(((clientY - top) * rows) / height));
    const cell = line?.getCell(Math.floor(((clientX - left) * cols) / width));
    return Boolean(cell?.getChars().startsWith(PLACEHOLDER));
  }

  mouse(kind, { x, y }, more = {}) {
    const where = { clientX: x, clientY: y, bubbles: true, cancelable: true, buttons: kind === "mouseup" ? 0 : 1 };
    const Kind = kind === "wheel" ? WheelEvent : MouseEvent;
    this.place.querySelector(".xterm-screen").dispatchEvent(new Kind(kind, { ...where, ...more }));
  }
}

function apart(first, second) {
  return Math.hypot(first.clientX - second.clientX, first.clientY - second.clientY);
}

// The button Ctrl is for the next letter.
holdCtrl = (data) => {
  const button = document.getElementById("ctrl");
  const [kind, text] = JSON.parse(data);
  if (button.ariaPressed !== "true" || kind !== "stdin" || !/^[a-z]$/i.test(text)) return data;
  button.setAttribute("aria-pressed", "false");
  return JSON.stringify([kind, String.fromCharCode(text.toUpperCase().charCodeAt(0) - 64)]);
};

terminalUsers.push((terminal) => new Fingers(terminal));
