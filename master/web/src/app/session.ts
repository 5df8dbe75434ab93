// Who this browser is to the master: by a login link or a token, until it logs out. The cookie that says so no script
// can read.
import { effect, signal } from "@preact/signals";
import { getJson, postJson } from "./api";
import { retry } from "./live";
import { link, loginWanted, tellError } from "./state";

export interface Person {
  role: "viewer" | "artist" | "admin";
  name: string; // may be empty
}

/// Null: the browser has not logged in; who is asked nothing need not.
export const person = signal<Person | null>(null);
/// What was wrong with the last login, for people.
export const loginFault = signal("");

export async function logIn(shown: { code: string } | { token: string }): Promise<void> {
  try {
    person.value = await postJson<Person>("/login", shown);
    loginFault.value = "";
    loginWanted.value = false;
    retry();
  } catch (error) {
    loginFault.value = error instanceof Error ? error.message : String(error);
  }
}

/// Begins anew, with nothing left of what was shown.
export function logOut(): void {
  postJson("/logout").then(() => location.reload(), tellError);
}

const loginLink = /^#\/login\/([^/?]+)$/;

/// Logs in with the address, when it is a login link: its code is good once, and does not stay there.
export async function followLoginLink(): Promise<void> {
  const code = loginLink.exec(location.hash)?.[1];
  if (!code) return;
  history.replaceState(null, "", "#/");
  await logIn({ code });
  if (loginFault.value) tellError(loginFault.value);
}

/// Until the result is called.
export const startSession = (): (() => void) =>
  effect(() => {
    if (link.value !== "open") return;
    getJson<{ session: Person | null }>("/login").then((answer) => (person.value = answer.session), tellError);
  });
