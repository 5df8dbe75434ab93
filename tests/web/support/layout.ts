// What a page's layout must keep: nothing outside the window, everything reached by Tab.
import type { Page } from "playwright-core";

/// What sticks out of the window, and is in nothing that could be scrolled; and whether the page itself scrolls.
export const outside = (page: Page): Promise<string[]> =>
  page.evaluate(() => {
    const scrolls = (element: Element): boolean => {
      for (let at: Element | null = element; at && at !== document.body; at = at.parentElement)
        if (/auto|scroll/.test(getComputedStyle(at).overflow)) return true;
      return false;
    };
    const root = document.documentElement;
    const found: string[] = [];
    if (root.scrollWidth > root.clientWidth || root.scrollHeight > root.clientHeight) found.push("the page scrolls");
    for (const element of document.body.querySelectorAll("*")) {
      const box = element.getBoundingClientRect();
      const visible = box.width > 1 && box.height > 1 && element.checkVisibility({ visibilityProperty: true });
      const out = box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1;
      if (visible && out && !scrolls(element)) found.push(`${element.tagName} ${element.className} ${box.right} ${box.bottom}`);
    }
    return found;
  });

/// The controls as they come in the page, those that Tab has to reach.
export const controls = (page: Page): Promise<string[]> =>
  page.evaluate(() => {
    const wanted = "a[href], button, input, select, textarea, summary, [tabindex]";
    const all = [...document.querySelectorAll<HTMLElement>(wanted)].filter((element) => {
      const disabled = element.matches(":disabled");
      return element.tabIndex >= 0 && !disabled && element.checkVisibility({ visibilityProperty: true });
    });
    // Of radio buttons of one name the chosen one is reached, or else the first.
    const radios = all.filter((element): element is HTMLInputElement => element.matches("input[type=radio]"));
    const skipped = radios.filter((radio) => {
      const group = radios.filter((each) => each.name === radio.name);
      return radio !== (group.find((each) => each.checked) ?? group[0]);
    });
    const reached = all.filter((element) => !skipped.some((radio) => radio === element));
    reached.forEach((element, place) => (element.dataset.control = `${place}`));
    return reached.map((_, place) => `${place}`);
  });

/// The controls in the order in which Tab goes through them, from the top of the page until it begins again; and
/// those that do not show that they have the focus.
export async function tabbed(page: Page): Promise<{ order: string[]; unmarked: string[] }> {
  const [order, unmarked]: [string[], string[]] = [[], []];
  for (;;) {
    await page.keyboard.press("Tab");
    const [control, marked, words] = await page.evaluate(() => {
      const focus = document.activeElement as HTMLElement;
      const style = getComputedStyle(focus);
      const framed = [...focus.querySelectorAll("*")].some((each) => {
        const after = getComputedStyle(each, "::after");
        return after.content !== "none" && after.borderTopStyle !== "none";
      });
      const isMarked = style.outlineStyle !== "none" || style.boxShadow !== "none" || framed;
      return [focus.dataset.control, isMarked, focus.outerHTML.slice(0, 120)] as const;
    });
    if (control === undefined || order.includes(control)) return { order, unmarked };
    order.push(control);
    if (!marked) unmarked.push(words);
  }
}
