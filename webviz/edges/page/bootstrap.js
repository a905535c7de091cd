// Called by viser's page with what the server tells it, whenever it has connected.
(told) => {
  const answers = [];
  window.webviz ??= { version: told.version, answer: (token) => answers.push(token), answers };
  // The server was replaced by one of another version.
  if (window.webviz.version !== told.version) return location.reload();

  // Below the page, wherever a proxy has put that. viser takes the address for a folder as well.
  const page = location.href.split(/[?#]/)[0].replace(/\/index\.html$/, "");
  const folder = `${page.replace(/\/$/, "")}/webviz/`;
  import(`${folder}main.js`).then(
    ({ connect }) => connect(told, folder),
    () => {
      const banner = document.createElement("div");
      banner.setAttribute("role", "alert");
      banner.style.cssText =
        "position: fixed; inset: 0 0 auto; z-index: 10000; padding: 0.5em 1em;" +
        "text-align: center; font: 600 14px/1.4 sans-serif; color: #fff; background: #b3261e";
      banner.textContent = "The scripts of webviz were not received. Reload this page.";
      document.body.append(banner);
    },
  );
}
