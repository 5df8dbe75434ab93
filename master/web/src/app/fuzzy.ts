// Finding entries by some of their letters.

export interface Match {
  score: number;
  places: number[]; // of the letters found, in the text
}

/// Whether the letters of the query are in the text in this order, and how well: beginnings of words and
/// letters side by side count most. Blanks in the query are ignored.
export function match(query: string, text: string): Match | null {
  const wanted = query.toLowerCase().replace(/\s+/g, "");
  const lower = text.toLowerCase();
  let best: Match | null = null;
  // The first letter may stand in many places; from each, the rest is taken as early as it comes.
  for (let start = lower.indexOf(wanted[0] ?? ""); start >= 0; start = lower.indexOf(wanted[0]!, start + 1)) {
    const found = from(start, wanted, lower);
    if (!found) break;
    if (!best || found.score > best.score) best = found;
    if (wanted === "") break;
  }
  return best;
}

function from(start: number, wanted: string, lower: string): Match | null {
  const places: number[] = [];
  let score = 0;
  let at = start;
  for (const letter of wanted) {
    const found = lower.indexOf(letter, at);
    if (found < 0) return null;
    const begins = found === 0 || !/[a-z0-9]/.test(lower[found - 1]!);
    const follows = places.length > 0 && places[places.length - 1] === found - 1;
    score += begins ? 8 : follows ? 6 : 1;
    places.push(found);
    at = found + 1;
  }
  return { score: score - lower.length / 100, places };
}

/// The entries that match, best first; those that match equally stay in their order.
export function filter<T>(
  query: string,
  entries: readonly T[],
  text: (entry: T) => string,
): { entry: T; match: Match }[] {
  const found: { entry: T; match: Match }[] = [];
  for (const entry of entries) {
    const matched = match(query, text(entry));
    if (matched) found.push({ entry, match: matched });
  }
  return query.trim() === "" ? found : found.sort((a, b) => b.match.score - a.match.score);
}
