import type { ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";

/// A component whose code is fetched when it is first shown.
export function lazy(name: string, load: () => Promise<ComponentType>): ComponentType {
  let loading: Promise<ComponentType> | null = null;
  return function Lazy() {
    const [part, setPart] = useState<{ Loaded: ComponentType } | null>(null);
    const [failed, setFailed] = useState(false);
    useEffect(() => {
      loading ??= load();
      loading.then(
        (Loaded) => setPart({ Loaded }),
        () => {
          loading = null;
          setFailed(true);
        },
      );
    }, [failed]);
    if (part) return <part.Loaded />;
    if (!failed) return <p class="loading quiet">Loading {name} …</p>;
    return (
      <p class="loading" role="alert">
        The part of the app for {name} could not be loaded.{" "}
        <button onClick={() => setFailed(false)}>Try again</button>
      </p>
    );
  };
}
