// Recorded runs and incidents, their reports, and what became of their return.
import { by, make, number, put } from "/dom.js";
import { on } from "/link.js";
import { say } from "/calls.js";
import { onTab } from "/tabs.js";
import { commands } from "/why.js";
import { words } from "/words.js";

const RECORD = "roslaunch robot_control sim.launch telemetry:=true";

on("slow", (slow) => put("data-return", slow.data_return && `data return: ${slow.data_return}`));

onTab(async (tab) => {
  if (tab !== "logs") return;
  const answer = await fetch("/api/runs").catch(() => null);
  if (!answer?.ok) return say("the list of runs cannot be read");
  const runs = await answer.json();
  by("run-list").replaceChildren(...runs.map(row));
  by("no-runs").replaceChildren();
  if (runs.length) return;
  const copied = make("div");
  commands(copied, [RECORD]);
  by("no-runs").append(words("Nothing is recorded yet. Start the robot with its recorder:"), copied);
});

function row(run) {
  const line = document.createElement("tr"), time = new Date(1000 * run.time).toLocaleString();
  for (const text of [`${run.name}, ${time}`, `${number(run.bytes / 1e6, 1)} MB`]) line.insertCell().textContent = text;
  const links = line.insertCell();
  for (const [text, path, target] of [["report", "report", "_blank"], ["download", "file", ""]]) {
    const href = `/api/runs/${run.id}/${path}`, rel = "noopener";
    links.append(make("a", { textContent: words(text), href, target, rel }), " ");
  }
  return line;
}
