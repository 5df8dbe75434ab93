// Questions that come faster than answers: one is under way, and of those that came meanwhile only the newest is asked.

export interface Newest<Question> {
  ask(question: Question): void;
  stop(): void; // forgets what is under way
}

export function newestWins<Question, Answer>(
  fetchAnswer: (question: Question, signal: AbortSignal) => Promise<Answer>,
  answered: (question: Question, answer: Answer) => void,
  failed: (question: Question, error: unknown) => void,
): Newest<Question> {
  let underWay: AbortController | null = null;
  let waiting: { question: Question } | null = null;

  const start = async (question: Question) => {
    const mine = (underWay = new AbortController());
    try {
      const answer = await fetchAnswer(question, mine.signal);
      if (underWay === mine) answered(question, answer);
    } catch (error) {
      if (underWay === mine) failed(question, error);
    }
    if (underWay !== mine) return;
    underWay = null;
    const next = waiting;
    waiting = null;
    if (next) void start(next.question);
  };

  return {
    ask(question) {
      if (underWay) waiting = { question };
      else void start(question);
    },
    stop() {
      underWay?.abort();
      underWay = waiting = null;
    },
  };
}
