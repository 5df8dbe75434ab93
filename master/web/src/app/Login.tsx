// Over the app while the master does not know who this browser is.
import { useState } from "preact/hooks";
import { logIn, loginFault } from "./session";
import { loginWanted } from "./state";
import "./login.css";

export function Login() {
  return loginWanted.value ? <LoginForm /> : null;
}

/// The master says what is wrong with the token.
function LoginForm() {
  const [token, setToken] = useState("");
  const fault = loginFault.value;
  return (
    <section class="login" aria-label="Login">
      <form
        onSubmit={(event) => {
          event.preventDefault();
          void logIn({ token: token.trim() });
        }}
      >
        <h1>This farm wants a login</h1>
        <p>
          Ask who runs it for a link: <code>rayfarm token new --role viewer --link</code> prints one (
          <code>artist</code> instead of <code>viewer</code> may also submit). Or show a token here:
        </p>
        <input
          type="password"
          aria-label="Token"
          aria-invalid={fault ? "true" : undefined}
          aria-describedby={fault ? "login-fault" : undefined}
          placeholder="XXXXX-XXXXX-..."
          autocomplete="off"
          spellcheck={false}
          value={token}
          onInput={(event) => setToken(event.currentTarget.value)}
        />
        <button type="submit" class="main" disabled={token.trim() === ""}>
          Log in
        </button>
        {fault && (
          <p id="login-fault" class="bad" role="alert">
            {fault}
          </p>
        )}
      </form>
    </section>
  );
}
