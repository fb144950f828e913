// What became of the constraints of a deformation.
import { choose, chosen, numberText, object, page, withUnit, word } from "./state";

export function Constraints() {
  const { constraints = [], conflicts = [], annotations } = page.objects[object.value];
  if (constraints.length === 0 && conflicts.length === 0) return null;
  return (
    <section aria-labelledby="constraints-title">
      <h2 id="constraints-title">{word("constraints")}</h2>
      {conflicts.length > 0 && (
        <ul class="conflicts">
          {conflicts.map((text, i) => (
            <li key={i}>
              <strong>{word("conflict")}</strong>: {text}
            </li>
          ))}
        </ul>
      )}
      <ul class="constraints">
        {constraints.map((one, i) => {
          const verdict = one.holds === undefined ? "unknown" : one.holds ? "holds" : "broken";
          return (
            <li key={i} class={one.members.includes(chosen.value) ? "chosen" : ""} data-verdict={verdict}>
              <span class={`verdict ${verdict}`}>
                <span aria-hidden="true">{{ holds: "✓", broken: "✗", unknown: "?" }[verdict]}</span> {word(verdict)}
              </span>{" "}
              <strong>{one.type}</strong>:{" "}
              {one.members.map((m, k) => (
                <span key={k}>
                  {k > 0 && ", "}
                  <button type="button" class="link" onClick={() => choose(m)}>
                    {annotations[m]?.tag || `#${annotations[m]?.id ?? m}`}
                  </button>
                </span>
              ))}{" "}
              <span class="quiet">
                {word("before")}: {one.before}, {word("after")}: {one.verdict}; {one.hard ? word("hard") : `${word("weight")} ${numberText(one.weight)}`}
              </span>
              {one.text && <div>{one.text}</div>}
              {one.deviations.length > 0 && (
                <dl>
                  {one.deviations.map((d, k) => (
                    <div key={k}>
                      <dt>{d.quantity}</dt>
                      <dd>
                        {d.value === null ? "–" : withUnit(d.value, d.unit)}
                        {d.tolerance !== null && ` (${word("atMost", withUnit(d.tolerance, d.unit))})`}
                      </dd>
                    </div>
                  ))}
                  {one.residual && (
                    <div>
                      <dt>{word("residual")}</dt>
                      <dd>{word("meanLargest", numberText(one.residual.mean), numberText(one.residual.largest))}</dd>
                    </div>
                  )}
                </dl>
              )}
            </li>
          );
        })}
      </ul>
    </section>
  );
}
