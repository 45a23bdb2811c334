// Sets every equation of the page.
for (const place of document.querySelectorAll(".equation")) {
  katex.render(place.textContent, place, {
    displayMode: place.tagName === "DIV",
    throwOnError: false,
  });
}
