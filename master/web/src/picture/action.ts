import type { Action } from "../app/actions";

/// An action on the picture; it is there while `enabled`.
export const act = (
  id: string,
  title: string,
  keys: string[],
  run: () => void,
  enabled: () => boolean = () => true,
): Action => ({ id, title, group: "Picture", keys, run, enabled });
