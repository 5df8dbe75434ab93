// From keys to actions.
import { actions, keyOf, type Action } from "./actions";

export interface Place {
  scope: string | null; // of the nearest [data-scope] around the focus
  takesText: boolean; // a text field: letters are for it
  takesArrows: boolean; // a slider, a choice: arrows are for it
  takesPress: boolean; // a button, a link: Enter and Space are for it
  dialog: boolean; // a dialog is open: keys are for it alone
  freeTab: boolean; // the pointer was last used on the picture or the rays: Tab need not move the focus
}

/// The action that a key means there, if any.
export function actionFor(key: string, place: Place, all: readonly Action[]): Action | undefined {
  if (place.dialog) return undefined;
  const plain = key.replace(/^Shift\+/, "");
  if (place.takesText && !/^(Ctrl\+.|Escape$)/.test(key)) return undefined;
  if (place.takesArrows && /^(Arrow|Home|End|Page)/.test(plain)) return undefined;
  if (place.takesPress && (plain === "Enter" || plain === "Space")) return undefined;
  if (plain === "Tab" && (!place.freeTab || key !== "Tab")) return undefined;
  const fitting = all.filter((action) => action.keys.includes(key) && (action.enabled?.() ?? true));
  return (
    fitting.find((action) => action.scope && action.scope === place.scope) ??
    fitting.find((action) => !action.scope)
  );
}

let pointerWasLast = false; // and on the picture or the rays

function placeOf(focus: Element | null): Place {
  const scope = focus?.closest<HTMLElement>("[data-scope]")?.dataset.scope ?? null;
  const input = focus instanceof HTMLInputElement ? focus.type : null;
  const control =
    focus?.matches("input, select, textarea, button, a, [role=separator], [role=option]") ?? false;
  return {
    scope,
    takesText:
      focus instanceof HTMLTextAreaElement ||
      (focus instanceof HTMLElement && focus.isContentEditable) ||
      (input !== null && !["checkbox", "radio", "range", "button", "file", "color"].includes(input)),
    takesArrows: focus instanceof HTMLSelectElement || input === "range" || input === "radio",
    takesPress: focus?.matches("button, a, summary, select, input") ?? false,
    dialog: document.querySelector("dialog[open]") !== null,
    freeTab: pointerWasLast && !control,
  };
}

export function startKeys(): void {
  addEventListener(
    "pointerdown",
    ({ target }) => {
      pointerWasLast =
        target instanceof Element && target.closest("[data-scope=picture], [data-scope=rays]") !== null;
    },
    true,
  );
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.isComposing) return;
    const action = actionFor(keyOf(event), placeOf(document.activeElement), actions.value);
    if (action) {
      event.preventDefault();
      action.run();
    } else if (event.key === "Tab") {
      pointerWasLast = false;
    }
  });
}
