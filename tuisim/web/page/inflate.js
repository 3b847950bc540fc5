// Unpacks zlib's format at once: the browser's own way would show a picture some frames after the text around it.
// https://www.rfc-editor.org/rfc/rfc1951
"use strict";

const inflate = (() => {
  // Bits behind the code of a length or a distance, and the smallest value of each code.
  const LENGTH_BITS = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0];
  const DISTANCE_BITS = Array.from({ length: 30 }, (_, code) => Math.max(0, (code >> 1) - 1));
  const sums = (first, bits) => bits.map((_, code) => bits.slice(0, code).reduce((sum, some) => sum + (1 << some), first));
  const LENGTHS = sums(3, LENGTH_BITS);
  LENGTHS[28] = 258;
  const DISTANCES = sums(1, DISTANCE_BITS);
  const ORDER = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
  const [END, HEAD_BYTES] = [256, 2];

  // A table by the next bits of the data: the symbol and, in its lowest four bits, how many bits its code has.
  const tableOf = (lengths) => {
    const most = Math.max(1, ...lengths);
    const table = new Uint16Array(1 << most);
    for (let length = 1, code = 0; length <= most; length++, code <<= 1) {
      lengths.forEach((own, symbol) => {
        if (own !== length) return;
        let reversed = 0;
        for (let bit = 0; bit < length; bit++) reversed |= ((code >> bit) & 1) << (length - 1 - bit);
        for (let at = reversed; at < table.length; at += 1 << length) table[at] = (symbol << 4) | length;
        code++;
      });
    }
    return table;
  };

  const FIXED = [
    tableOf(Array.from({ length: 288 }, (_, symbol) => (symbol < 144 ? 8 : symbol < 256 ? 9 : symbol < 280 ? 7 : 8))),
    tableOf(new Array(30).fill(5)),
  ];

  return (data, size) => {
    const out = new Uint8Array(size);
    let [at, held, count, to] = [HEAD_BYTES, 0, 0, 0];
    const bits = (wanted) => {
      for (; count < wanted; count += 8) held |= data[at++] << count;
      const value = held & ((1 << wanted) - 1);
      held >>>= wanted;
      count -= wanted;
      return value;
    };
    const symbol = (table) => {
      for (; count < 15; count += 8) held |= data[at++] << count;
      const found = table[held & (table.length - 1)];
      if (!found) throw new Error("not in zlib's format");
      held >>>= found & 15;
      count -= found & 15;
      return found >> 4;
    };
    const tables = () => {
      const [literals, distances, codes] = [bits(5) + 257, bits(5) + 1, bits(4) + 4];
      const ofLengths = new Array(19).fill(0);
      for (let code = 0; code < codes; code++) ofLengths[ORDER[code]] = bits(3);
      const table = tableOf(ofLengths);
      const lengths = [];
      while (lengths.length < literals + distances) {
        const code = symbol(table);
        if (code < 16) lengths.push(code);
        else if (code === 16) lengths.push(...new Array(3 + bits(2)).fill(lengths.at(-1)));
        else lengths.push(...new Array(code === 17 ? 3 + bits(3) : 11 + bits(7)).fill(0));
      }
      return [tableOf(lengths.slice(0, literals)), tableOf(lengths.slice(literals))];
    };
    const stored = () => {
      // From the next byte on; whole bytes may have been read too far.
      at -= count >> 3;
      [held, count] = [0, 0];
      const length = data[at] | (data[at + 1] << 8);
      out.set(data.subarray(at + 4, at + 4 + length), to);
      [at, to] = [at + 4 + length, to + length];
    };
    for (let isLast = 0; !isLast; ) {
      isLast = bits(1);
      const kind = bits(2);
      if (kind === 0) {
        stored();
        continue;
      }
      const [literals, distances] = kind === 1 ? FIXED : tables();
      for (let code = symbol(literals); code !== END; code = symbol(literals)) {
        if (code < END) {
          out[to++] = code;
          continue;
        }
        const length = LENGTHS[code - 257] + bits(LENGTH_BITS[code - 257]);
        const far = symbol(distances);
        const from = to - DISTANCES[far] - bits(DISTANCE_BITS[far]);
        for (let step = 0; step < length; step++) out[to + step] = out[from + step];
        to += length;
      }
    }
    return out;
  };
})();
