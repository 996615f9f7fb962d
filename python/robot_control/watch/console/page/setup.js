// What is set once: who may send commands, the programs of the robot, odometry, limits, the simulation, this computer.
import { by, choices, list, make, put } from "/dom.js";
import { on } from "/link.js";
import { release } from "/drive.js";
import { say } from "/calls.js";
import { words } from "/words.js";

on("slow", (slow) => {
  put("senders", slow.senders.join(", ") || "no node");
  list("sources", [...slow.sources, ...slow.revoked.map((name) => `${name}: revoked, has to send zero`)]);
  list("nodes", Object.entries(slow.nodes).map(([name, there]) => there ? `● ${name}` : `○ ${name} (silent)`));
  list("broken", Object.entries(slow.broken).map(([name, count]) => `${name}: ${count} messages could not be read`));
  choices("component", slow.components);
  choices("kind", slow.kinds);
  by("simulation").hidden = !slow.simulated;
  put("pause", slow.paused ? "Go on" : "Pause");
  put("faults", slow.faults && slow.faults !== "none" ? `injected: ${slow.faults}` : "");
});

by("examine").addEventListener("click", async () => {
  const answer = await fetch("/api/doctor").catch(() => null);
  if (!answer?.ok) return say(`the machine was not examined: ${answer ? await answer.text() : "no answer"}`);
  by("finding-list").replaceChildren(...(await answer.json()).map(({ verdict, name, value, why, remedy }) => {
    const line = make("tr", { title: why });
    for (const text of [verdict, name.replaceAll("_", " "), remedy ? `${value}; remedy: ${remedy}` : value]) {
      line.insertCell().textContent = words(text);
    }
    return line;
  }));
});

by("logout").addEventListener("click", async () => {
  release();
  await fetch("/api/logout", { method: "POST" }).catch(() => null);
  location.assign("/login");
});
