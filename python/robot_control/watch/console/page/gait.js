// A robot on legs: its posture, its gait, the feet that bear, and the ground below them.
import { by, make, number, put, rows, show } from "/dom.js";
import { onRead } from "/link.js";
import { words } from "/words.js";

const LEVEL = 0.06;  // m/m: a slope below it counts as level (posture/ground_slope.h)
const SIDES = ["front", "front left", "left", "rear left", "rear", "rear right", "right", "front right"];

onRead("fast", ({ legs }) => {
  by("gait-card").hidden = !legs;
  if (!legs) return;
  const { posture, gait, chosen, gaits, feet, slope } = legs, whose = chosen === "auto" ? "by the speed" : "chosen";
  put("posture", gait ? `${posture}, ${gait} (${whose})` : posture);
  put("mini-gait", (gait || posture).replace("_", " "));
  rows(by("gaits"), gaits.length, (i) => {
    const button = make("button", { textContent: words(gaits[i].replace("_", " ")) });
    Object.assign(button.dataset, { call: "set_gait", gait: gaits[i] });
    return button;
  }).forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.gait === chosen)));
  rows(by("feet"), feet.length, () => make("span", {}, make("span"), make("b"))).forEach((foot, i) => {
    const { name, bears, load, met_riser, reaching } = feet[i];
    foot.className = met_riser || reaching ? "meets" : bears ? "bears" : "";
    foot.title = words(name.replace("_", " "));
    show(foot.firstChild, name.split("_").map((word) => word.charAt(0).toUpperCase()).join(""));
    const meets = met_riser ? "obstacle" : reaching ? "no ground" : "";
    show(foot.lastChild, meets ? words(meets) : bears ? `${number(load, 0)} N` : gait ? words("swings") : "–");
  });
  const rise = Math.hypot(...slope), side = SIDES[(Math.round(Math.atan2(slope[1], slope[0]) * 4 / Math.PI) + 8) % 8];
  by("slope").hidden = !(rise > LEVEL);
  put("slope", words(`The ground rises ${number(Math.atan(rise) * 180 / Math.PI, 0)}° to the ${side}.`));
});
