import { layer } from "../app/state";
import { type MapEntry, type Reduction, reductions } from "../app/types";

/// How a map is made of many samples, and by whose formula.
export function MapChoices({ map }: { map: MapEntry }) {
  if (!map.reduces && !map.compat) return null;
  return (
    <div class="line">
      {map.reduces && (
        <>
          <label for="map-reduction" title="Which value a pixel gets whose samples met several surfaces">
            Reduction
          </label>
          <select
            id="map-reduction"
            value={layer.value.reduce}
            onChange={(event) =>
              (layer.value = { ...layer.peek(), reduce: event.currentTarget.value as Reduction })
            }
          >
            {reductions.map((each) => (
              <option key={each} value={each}>
                {each}
              </option>
            ))}
          </select>
        </>
      )}
      {map.compat && (
        <label class="check" title="The original renderer's formula">
          <input
            type="checkbox"
            checked={layer.value.compat}
            onChange={(event) => (layer.value = { ...layer.peek(), compat: event.currentTarget.checked })}
          />
          original
        </label>
      )}
    </div>
  );
}
