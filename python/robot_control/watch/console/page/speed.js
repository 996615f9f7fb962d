// What was asked for and by whom, after the limits, measured, and true: the same four colours everywhere.
import { by, number, put, show } from "/dom.js";
import { on, onRead } from "/link.js";

export const KINDS = ["asked", "limited", "measured", "true"];

onRead("fast", (frame) => {
  for (const name of KINDS) {
    for (const [at, axis] of ["v", "w", "l"].entries()) show(by(`${name}-${axis}`), number(frame[name]?.[at]));
  }
  by("true-row").hidden = !frame.true;
  show(by("speed"), number(frame.measured?.[0]));
  show(by("mini-v"), number(frame.measured?.[0]));
  show(by("mini-w"), number(frame.measured?.[1]));
  const [x, y, z, roll, pitch, yaw] = frame.pose ?? [];
  show(by("pose"), `${number(x)} m, ${number(y)} m, ${number(z)} m; ${[roll, pitch, yaw].map((angle) => number(angle)).join(", ")} rad`);
});
on("slow", (slow) => put("asked-by", slow.asked_by || "no node"));
