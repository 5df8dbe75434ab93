// Asks before what cannot be undone.
import { signal } from "@preact/signals";
import { Dialog } from "./Dialog";

interface Question {
  title: string;
  text: string;
  yes: string; // what the button does, as a verb
  run: () => void;
}

const asked = signal<Question | null>(null);

export function confirm(question: Question): void {
  asked.value = question;
}

export function Confirm() {
  const question = asked.value;
  if (!question) return null;
  const close = () => (asked.value = null);
  return (
    <Dialog label={question.title} class="confirm" close={close}>
      <div>
        <h2>{question.title}</h2>
        <p>{question.text}</p>
        <div class="answers">
          <button onClick={close}>Keep as it is</button>
          <button
            class="main"
            onClick={() => {
              close();
              question.run();
            }}
          >
            {question.yes}
          </button>
        </div>
      </div>
    </Dialog>
  );
}
