import { describe, expect, it } from "vitest";
import { newestWins } from "../../../master/web/src/rays/newest";

/// A master that answers when told to.
function farm() {
  const asked: { question: string; signal: AbortSignal; answer: () => void; fail: (error: Error) => void }[] =
    [];
  const log: string[] = [];
  const newest = newestWins(
    (question: string, signal) =>
      new Promise<string>((resolve, reject) => {
        asked.push({ question, signal, answer: () => resolve(question.toUpperCase()), fail: reject });
      }),
    (question, answer) => log.push(`${question} ${answer}`),
    (question, error) => log.push(`${question} ${(error as Error).message}`),
  );
  return { newest, asked, log };
}
const settled = () => new Promise<void>((resolve) => setImmediate(resolve));

describe("of questions that come faster than answers", () => {
  it("one is under way, and the newest is next", async () => {
    const { newest, asked, log } = farm();
    for (const question of ["a", "b", "c", "d"]) newest.ask(question);
    expect(asked.map((a) => a.question)).toEqual(["a"]);
    asked[0]!.answer();
    await settled();
    expect(asked.map((a) => a.question)).toEqual(["a", "d"]);
    asked[1]!.answer();
    await settled();
    expect(log).toEqual(["a A", "d D"]);
    expect(asked).toHaveLength(2);
  });

  it("one that fails does not stop the next", async () => {
    const { newest, asked, log } = farm();
    newest.ask("a");
    newest.ask("b");
    asked[0]!.fail(new Error("no such pixel"));
    await settled();
    asked[1]!.answer();
    await settled();
    expect(log).toEqual(["a no such pixel", "b B"]);
  });

  it("none is answered after the stop, and new ones may come", async () => {
    const { newest, asked, log } = farm();
    newest.ask("a");
    newest.ask("b");
    newest.stop();
    expect(asked[0]!.signal.aborted).toBe(true);
    newest.ask("c");
    asked[0]!.answer();
    asked[1]!.answer();
    await settled();
    expect(asked.map((a) => a.question)).toEqual(["a", "c"]);
    expect(log).toEqual(["c C"]);
  });
});
