import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import "./dialog.css";

interface Props {
  label: string;
  class?: string;
  close: () => void;
  children: ComponentChildren;
}

/// A modal dialog: the browser keeps the focus inside, Escape and a click beside it close it, and the focus
/// goes back to where it was.
export function Dialog({ label, class: name, close, children }: Props) {
  const element = useRef<HTMLDialogElement>(null);
  // Before anything else happens: the next key is already the dialog's.
  useLayoutEffect(() => {
    const dialog = element.current!;
    dialog.showModal();
    return () => dialog.close();
  }, []);
  return (
    <dialog
      ref={element}
      class={name}
      aria-label={label}
      onCancel={(event) => {
        event.preventDefault();
        close();
      }}
      onClose={() => element.current && close()}
      onClick={(event) => {
        if (event.target === element.current) close();
      }}
    >
      {children}
    </dialog>
  );
}
