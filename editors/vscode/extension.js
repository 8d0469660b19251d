// Starts `umbrage lsp` for tables; everything else is said over the Language Server Protocol.
const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

exports.activate = async function () {
  const settings = workspace.getConfiguration("umbrage");
  const args = settings.get("allowOutside") ? ["lsp", "--allow-outside"] : ["lsp"];
  const server = { command: settings.get("command"), args };
  client = new LanguageClient("umbrage", "Umbrage", server, {
    documentSelector: [{ language: "umbrage" }],
    initializationOptions: {
      pictures: settings.get("pictures"),
      profiles: settings.get("profiles"),
      levels: settings.get("levels"),
    },
  });
  await client.start();
};

exports.deactivate = () => client?.stop();
