import type { Action } from "../app/actions";

/// An action on the picture; it is there while `enabled`.
export const act = (
  id: string,
  title: string,
  keys: string[],
  run: () => void,
  enabled: () => boolean = () => true,
): Action => ({ id, title, group: "Picture", keys, run, enabled });

/// What hands do without keys: told in the help beside the actions, done where the pointer is.
export const gesture = (id: string, title: string, hands: string[]): Action =>
  act(
    `gesture-${id}`,
    title,
    hands,
    () => undefined,
    () => false,
  );
