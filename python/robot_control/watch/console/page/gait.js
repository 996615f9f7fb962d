// A robot on legs: its posture, its gait, and the feet that bear.
import { by, make, number, put, rows, show } from "/dom.js";
import { onRead } from "/link.js";
import { words } from "/words.js";

onRead("fast", ({ legs }) => {
  by("gait-card").hidden = !legs;
  if (!legs) return;
  const { posture, gait, chosen, gaits, feet } = legs, whose = chosen === "auto" ? "by the speed" : "chosen";
  put("posture", gait ? `${posture}, ${gait} (${whose})` : posture);
  put("mini-gait", (gait || posture).replace("_", " "));
  rows(by("gaits"), gaits.length, (i) => {
    const button = make("button", { textContent: words(gaits[i].replace("_", " ")) });
    Object.assign(button.dataset, { call: "set_gait", gait: gaits[i] });
    return button;
  }).forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.gait === chosen)));
  rows(by("feet"), feet.length, () => make("span", {}, make("span"), make("b"))).forEach((foot, i) => {
    const { name, bears, load } = feet[i];
    foot.className = bears ? "bears" : "";
    foot.title = words(name.replace("_", " "));
    show(foot.firstChild, name.split("_").map((word) => word.charAt(0).toUpperCase()).join(""));
    show(foot.lastChild, bears ? `${number(load, 0)} N` : gait ? words("swings") : "–");
  });
});
