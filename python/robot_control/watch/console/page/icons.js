// The signs of tabs and buttons: lines in a square of 24.
const PATHS = {
  drive: "M12 3v18M3 12h18M12 3l-3 3M12 3l3 3M12 21l-3-3M12 21l3-3M3 12l3-3M3 12l3 3M21 12l-3-3M21 12l-3 3",
  map: "M9 4L3 6v14l6-2 6 2 6-2V4l-6 2-6-2zM9 4v14M15 6v14",
  plots: "M4 4v16h16M7 15l4-5 4 3 5-7",
  logs: "M6 3h12v18H6zM9 8h6M9 12h6M9 16h4",
  setup: "M4 7h10M18 7h2M4 17h2M10 17h10M14 5v4M6 15v4",
};
export function icon(name) {
  const space = "http://www.w3.org/2000/svg", svg = document.createElementNS(space, "svg");
  const path = document.createElementNS(space, "path");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  path.setAttribute("d", PATHS[name]);
  svg.append(path);
  return svg;
}
