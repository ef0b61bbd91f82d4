// Chooses light or dark before anything is drawn; follows the system until a choice is made.
(() => {
  'use strict';
  const root = document.documentElement;
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let choice = 'auto';
  let printing = false;
  const apply = () => {
    const theme = printing ? 'light' : choice === 'auto' ? (dark.matches ? 'dark' : 'light') : choice;
    if (root.dataset.theme !== theme) {
      root.dataset.theme = theme;
      dispatchEvent(new Event('themechange'));
    }
  };
  const print = (on) => { printing = on; apply(); };
  dark.addEventListener('change', apply);
  addEventListener('beforeprint', () => print(true));
  addEventListener('afterprint', () => print(false));
  addEventListener('DOMContentLoaded', () => {
    document.getElementById('theme').addEventListener('change', (event) => {
      choice = event.target.value;
      apply();
    });
  });
  apply();
})();
