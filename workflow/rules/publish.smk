# Pictures and the page.
