declare module "embedded:tables" {
  /** The files of the repository that the page brings along. */
  const files: { name: string; group: string; title: string; text: string }[];
  export default files;
}
declare module "*.tmLanguage.json" {
  const grammar: unknown;
  export default grammar;
}
