// Sorts and filters the table of students. Without it the page shows the same, in one order.
(() => {
  const table = document.querySelector("table.students");
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const heads = [...table.tHead.rows[0].cells];
  const goals = heads.slice(3, -1);

  const bar = document.createElement("div");
  bar.className = "filter";
  const search = document.createElement("input");
  search.type = "search";
  search.placeholder = "filter: name, reason, text of a line";
  search.setAttribute("aria-label", "filter students");
  const choice = document.createElement("select");
  choice.setAttribute("aria-label", "which students");
  const add = (value, text) => choice.add(new Option(text, value));
  add("", "all students");
  add("full", "all points");
  add("part", "not all points");
  add("none", "no points");
  goals.forEach((head, at) => add(String(at + 3), "missed: " + head.textContent));
  const count = document.createElement("span");
  count.className = "soft";
  bar.append(search, choice, count);
  table.closest(".wide").before(bar);

  const level = (row, at) => row.cells[at].className.match(/\b(met|part|missed)\b/)?.[0];
  const chosen = (row) => {
    switch (choice.value) {
      case "": return true;
      case "full": return level(row, 1) === "met";
      case "part": return level(row, 1) !== "met";
      case "none": return level(row, 1) === "missed";
      default: return level(row, Number(choice.value)) !== "met";
    }
  };
  const show = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !(chosen(row) && words.every((word) => text.includes(word)));
      shown += !row.hidden;
    }
    count.textContent = `${shown} of ${rows.length}`;
    const goal = goals[Number(choice.value) - 3]?.textContent;
    for (const dot of document.querySelectorAll(".misses circle")) {
      dot.style.display = goal && dot.dataset.goal !== goal ? "none" : "";
    }
  };
  search.addEventListener("input", show);
  choice.addEventListener("change", show);

  const number = (text) => (/^-?[\d.]+%?$/.test(text) ? parseFloat(text) : NaN);
  const order = new Intl.Collator(undefined, { numeric: true });
  const sort = (at, falls) => {
    const value = (row) => row.cells[at].textContent.trim();
    const compare = (one, other) => {
      const [first, second] = [number(value(one)), number(value(other))];
      return Number.isNaN(first) || Number.isNaN(second) ? order.compare(value(one), value(other)) : first - second;
    };
    rows.sort((one, other) => (falls ? compare(other, one) : compare(one, other)));
    body.append(...rows);
    heads.forEach((head, place) =>
      head.setAttribute("aria-sort", place !== at ? "none" : falls ? "descending" : "ascending"));
  };
  heads.forEach((head, at) => {
    const button = document.createElement("button");
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => sort(at, head.getAttribute("aria-sort") === "ascending"));
  });

  for (const row of document.querySelectorAll("table.goals tbody tr")) {
    const at = goals.findIndex((head) => head.textContent === row.cells[0].textContent);
    row.title = "show who missed it";
    row.addEventListener("click", () => {
      choice.value = String(at + 3);
      show();
      table.closest("section").scrollIntoView();
    });
  }
  show();
})();
