import { useState } from "preact/hooks";
import { postJson } from "../app/api";
import { tell } from "../app/state";

/// Has the master dial a worker that listens. What is wrong with an address, the master says.
export function DialForm() {
  const [address, setAddress] = useState("");
  const [fault, setFault] = useState("");
  async function dial() {
    try {
      await postJson("/workers", { dial: address.trim() });
      tell(`The master dials ${address.trim()}.`);
      setAddress("");
      setFault("");
    } catch (error) {
      setFault(error instanceof Error ? error.message : String(error));
    }
  }
  return (
    <form
      class="dial"
      onSubmit={(event) => {
        event.preventDefault();
        void dial();
      }}
    >
      {fault && (
        <span id="dial-fault" class="bad" role="alert">
          {fault}
        </span>
      )}
      <input
        aria-label="Worker to dial, as NAME=HOST:PORT"
        aria-invalid={fault ? "true" : undefined}
        aria-describedby={fault ? "dial-fault" : undefined}
        placeholder="NAME=HOST[:PORT]"
        autocomplete="off"
        spellcheck={false}
        value={address}
        onInput={(event) => setAddress(event.currentTarget.value)}
      />
      <button type="submit" disabled={address.trim() === ""}>
        Dial a worker
      </button>
    </form>
  );
}
