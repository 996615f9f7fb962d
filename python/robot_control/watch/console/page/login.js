// The login, and the first one by a link that works once: /login#LINK.
import { words } from "/words.js";

const by = (id) => document.getElementById(id);
const link = location.hash.slice(1);
history.replaceState(null, "", "/login");  // the link stays in no history
if (link) {
  by("name-row").hidden = true;
  by("name").required = false;
  by("password-label").textContent = "New password, 10 characters at least";
  by("password").autocomplete = "new-password";
}

by("login").addEventListener("submit", async (event) => {
  event.preventDefault();
  const password = by("password").value;
  const body = link ? { link, password } : { name: by("name").value, password };
  by("message").textContent = "…";
  try {
    const answer = await fetch("/api/login", {
      method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body),
    });
    if (answer.ok) location.assign("/");
    else by("message").textContent = words(await answer.text());
  } catch {
    by("message").textContent = words("The console does not answer.");
  }
});
