// What every report page does: it unpacks pictures and numbers, opens folds, and shows one variant or mesh at a time.
const annulus = (() => {
  'use strict';
  const unpacked = (script) => pako.inflate(Uint8Array.from(atob(script.textContent.trim()), (c) => c.charCodeAt(0)), {to: 'string'});
  const numbers = (box) => JSON.parse(unpacked(box.querySelector('script.data')));
  const makers = [];

  /// Everything in a part of the page that is still packed.
  function show(part) {
    for (const script of part.querySelectorAll('script.picture')) {
      script.insertAdjacentHTML('afterend', unpacked(script));
      script.remove();
    }
    for (const {selector, make} of makers)
      for (const box of part.querySelectorAll(selector)) {
        if (box.made) continue;
        box.made = true;
        make(box);
      }
    showLines(part);
  }

  /// The line a reader chose by its name, and the names to choose from.
  function chosenLine() {
    const select = document.querySelector('select[data-choose=line]');
    return {line: select ? select.value : '', names: select ? [...select.options].map((o) => o.value).filter(Boolean) : []};
  }

  /// Of lines with a name to choose from, the chosen one.
  function showLines(part) {
    const {line, names} = chosenLine();
    for (const mark of part.querySelectorAll('[data-line]'))
      if (names.includes(mark.dataset.line)) mark.style.display = line && mark.dataset.line !== line ? 'none' : '';
  }

  function open(fold) {
    fold.open = true;
    show(fold);
  }

  /// The target of a link may lie in a fold.
  function reveal() {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    for (let fold = target.closest('details'); fold; fold = fold.parentElement.closest('details')) open(fold);
    target.scrollIntoView();
  }

  /// Pictures of other variants or meshes than the chosen ones are hidden.
  function choose() {
    const chosen = [...document.querySelectorAll('select[data-choose]')].map((s) => [s.dataset.choose, s.value]);
    for (const picture of document.querySelectorAll('[data-variant], [data-mesh]'))
      picture.hidden = chosen.some(([what, value]) => value && picture.dataset[what] && picture.dataset[what] !== value);
    showLines(document);
    window.dispatchEvent(new Event('annulus:lines'));
    window.dispatchEvent(new Event('resize'));
  }

  function begin() {
    for (const library of document.querySelectorAll('script.library')) {
      const script = document.createElement('script');
      script.textContent = unpacked(library);
      document.head.append(script);
    }
    for (const script of document.querySelectorAll('script.own')) {
      const own = document.createElement('script');
      own.textContent = script.textContent;
      document.head.append(own);
    }
    const folds = [...document.querySelectorAll('details.section')];
    for (const fold of folds) fold.addEventListener('toggle', () => fold.open && show(fold));
    for (const part of document.querySelectorAll('main > :not(details.section)')) show(part);
    for (const select of document.querySelectorAll('select[data-choose]')) select.addEventListener('change', choose);
    choose();
    let opened = [];
    window.addEventListener('beforeprint', () => {
      opened = folds.filter((fold) => !fold.open);
      opened.forEach(open);
    });
    window.addEventListener('afterprint', () => opened.forEach((fold) => { fold.open = false; }));
    window.addEventListener('hashchange', reveal);
    for (const link of document.querySelectorAll('a[href^="#"]')) link.addEventListener('click', () => setTimeout(reveal));
    reveal();
  }

  return {make: (selector, make) => makers.push({selector, make}), numbers, show, open, begin, chosenLine};
})();
