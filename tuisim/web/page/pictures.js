// Draws pictures over the terminal, pixel by pixel: kitty's graphics at placeholders, which the terminal takes for text.
// https://sw.kovidgoyal.net/kitty/graphics-protocol/#unicode-placeholders
"use strict";

const PLACEHOLDER = "\u{10eeee}";
const DIACRITICS = "\u0305\u030d\u030e\u0310\u0312\u033d\u033e\u033f";
// Commands of kitty come as this one: the terminal ignores the codes that they usually come in.
const COMMAND = 7766;
const NAME = "\x1bP>|tuisim 1\x1b\\";
const DONE = "\x1b_Gi=31;OK\x1b\\";
const ATTRIBUTES = "\x1b[?1;2c";

// The app numbers the images of each picture on their own.
const pictureOf = (number) => (number - 1) >> 16;

class Pictures {
  constructor(terminal) {
    this.terminal = terminal;
    this.images = new Map();
    this.coming = null;
    this.told = "";
    this.canvas = document.createElement("canvas");
    this.canvas.className = "pictures";
    terminal.options.windowOptions = { getCellSizePixels: true };
    const parser = terminal.parser;
    parser.registerCsiHandler({ prefix: ">", final: "q" }, () => this.answer(NAME));
    parser.registerCsiHandler({ final: "t" }, ([what]) => what === 16 && this.tell());
    parser.registerOscHandler(COMMAND, (command) => this.take(command));
    terminal.onRender(({ start, end }) => this.draw(start, end));
  }

  answer(text) {
    this.terminal.input(text, false);
    return true;
  }

  // Width and height of a cell in pixels of the screen.
  cell() {
    const { cols, rows, element } = this.terminal;
    const { width, height } = element.querySelector(".xterm-screen").getBoundingClientRect();
    return [Math.round((width * devicePixelRatio) / cols), Math.round((height * devicePixelRatio) / rows)];
  }

  // The size of a cell, and that of the terminal in cells and pixels of the mouse, which are those of the style sheet.
  size() {
    const [width, height] = this.cell();
    const { cols, rows, element } = this.terminal;
    const area = element.querySelector(".xterm-screen").getBoundingClientRect();
    return `\x1b[6;${height};${width}t\x1b[48;${rows};${cols};${Math.round(area.height)};${Math.round(area.width)}t`;
  }

  // Tells the sizes, and from now on the place of the mouse in pixels.
  tell(more = "") {
    this.told = this.size();
    this.terminal.write("\x1b[?1016h");
    return this.answer(this.told + more);
  }

  take(command) {
    const [, words, data] = /^G([^;]*);?(.*)$/s.exec(command) || [];
    const keys = Object.fromEntries((words || "").split(",").map((word) => word.split("=")));
    if (keys.a === "q") return this.answer(DONE);
    if (keys.a === "d") {
      if (keys.d === "I") this.images.delete(Number(keys.i));
      else this.images.clear();
      return true;
    }
    if (keys.a === "T") this.coming = { keys, data: "" };
    if (this.coming) {
      this.coming.data += data;
      if (keys.m !== "1") {
        this.keep(this.coming.keys, this.coming.data);
        this.coming = null;
      }
    }
    return true;
  }

  // At once, so that it is there when the terminal shows its placeholders.
  keep({ i, s, v, c, r }, data) {
    const packed = Uint8Array.from(atob(data), (character) => character.charCodeAt(0));
    const [width, height] = [Number(s), Number(v)];
    const rgb = inflate(packed, 3 * width * height);
    const pixels = new ImageData(width, height);
    const colors = new Uint32Array(pixels.data.buffer);
    for (let at = 0, to = 0; at < rgb.length; at += 3, to++) {
      colors[to] = 0xff000000 | (rgb[at + 2] << 16) | (rgb[at + 1] << 8) | rgb[at];
    }
    const bitmap = new OffscreenCanvas(width, height);
    bitmap.getContext("2d").putImageData(pixels, 0, 0);
    this.images.set(Number(i), { cols: Number(c), rows: Number(r), bitmap });
  }

  draw(start, end) {
    const { terminal, canvas } = this;
    const [width, height] = this.cell();
    const [across, down] = [terminal.cols * width, terminal.rows * height];
    if (canvas.width !== across || canvas.height !== down || !canvas.parentElement) {
      terminal.element.querySelector(".xterm-screen").append(canvas);
      [canvas.width, canvas.height] = [across, down];
      [canvas.style.width, canvas.style.height] = [`${across / devicePixelRatio}px`, `${down / devicePixelRatio}px`];
      this.drawn = new Map();
      [start, end] = [0, terminal.rows - 1];
    }
    // The app asks when the terminal has another size, but it is not told of other cells.
    if (this.told && this.told !== this.size()) this.tell(ATTRIBUTES);
    for (let row = start; row <= end; row++) this.drawRow(row);
  }

  drawRow(row) {
    const { terminal, canvas, drawn } = this;
    const context = canvas.getContext("2d");
    const buffer = terminal.buffer.active;
    const line = buffer.getLine(buffer.viewportY + row);
    const [width, height] = [canvas.width / terminal.cols, canvas.height / terminal.rows];
    const clear = (col) => {
      if (drawn.delete(row * terminal.cols + col)) context.clearRect(col * width, row * height, width, height);
    };
    let cell;
    for (let col = 0; line && col < terminal.cols; col++) {
      cell = line.getCell(col, cell);
      const text = cell.getChars();
      const place = row * terminal.cols + col;
      if (!text.startsWith(PLACEHOLDER)) {
        clear(col);
        continue;
      }
      const number = cell.getFgColor();
      const image = this.images.get(number);
      if (!image) {
        // What was there before stays until the image has come, but not of another picture.
        if (drawn.get(place) !== pictureOf(number)) clear(col);
        continue;
      }
      const [down, across] = [...text].slice(1).map((mark) => DIACRITICS.indexOf(mark));
      const [w, h] = [image.bitmap.width / image.cols, image.bitmap.height / image.rows];
      context.drawImage(image.bitmap, across * w, down * h, w, h, col * width, row * height, width, height);
      drawn.set(place, pictureOf(number));
    }
  }
}

if (window.OffscreenCanvas) terminalUsers.push((terminal) => new Pictures(terminal));
