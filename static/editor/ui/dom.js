/**
 * A new element. Text is always set as text: nothing a user wrote is ever read as HTML.
 *
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {{class?: string, text?: string, attributes?: Record<string, string>, click?: () => void}} [how]
 * @param {...Node} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function element(tag, how = {}, ...children) {
  const node = document.createElement(tag);
  if (how.class) node.className = how.class;
  if (how.text !== undefined) node.textContent = how.text;
  for (const [name, value] of Object.entries(how.attributes ?? {})) node.setAttribute(name, value);
  if (how.click) node.addEventListener("click", how.click);
  node.append(...children);
  return node;
}
