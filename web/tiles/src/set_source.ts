// Where a tile set comes from: an address, or a folder of this computer.

export interface SetSource {
  /** What a reader calls it: the name of its folder. */
  readonly name: string;
  /** Of its tileset.json. Addresses of tiles are relative to it. */
  readonly url: string;
  /** Reads a file below the set's folder instead of asking a server. Rejects if it is not there. */
  readonly read?: (path: string) => Promise<Blob>;
}

/** The set at an address, relative to the page: of a tileset.json, or of the folder that has one. */
export function setAt(address: string): SetSource {
  const url = new URL(address, document.baseURI);
  if (url.pathname.endsWith("/")) url.pathname += "tileset.json";
  const folders = url.pathname.split("/").slice(0, -1).filter(Boolean);
  return { name: decodeURIComponent(folders.at(-1) ?? url.host), url: url.href };
}

/** Files of a folder get addresses below the page, which no server is asked for. */
function setIn(name: string, read: (path: string) => Promise<Blob>): SetSource {
  return { name, url: new URL("folder/tileset.json", document.baseURI).href, read };
}

/** The renderer asks for "//view" where the set's folder is the root of a host. Not every server takes that. */
export function withOneSlash(url: string): string {
  const address = new URL(url);
  address.pathname = address.pathname.replace(/^\/+/, "/");
  return address.href;
}

/** The path below the set's folder that an address means. */
export function pathInSet(source: SetSource, url: string): string {
  return decodeURIComponent(new URL(url).pathname.slice(new URL(".", source.url).pathname.length));
}

/** The set in files of a chosen folder, which have their paths. */
export function setOfFiles(files: readonly File[]): SetSource {
  const root = files.find(({ name }) => name === "tileset.json");
  const folder = (root ?? files[0])?.webkitRelativePath.split("/").slice(0, -1).join("/") ?? "";
  const byPath = new Map(files.map((file) => [file.webkitRelativePath, file]));
  return setIn(folder.split("/").at(-1) ?? "", async (path) => {
    const file = byPath.get(`${folder}/${path}`);
    if (!file) throw new Error(`${path} is not in the folder`);
    return file;
  });
}

/** The set in a dropped folder; null if something else was dropped. Its files are looked up one by one. */
export function setOfDrop(items: DataTransferItemList): SetSource | null {
  for (const item of items) {
    const entry = item.webkitGetAsEntry();
    if (!entry?.isDirectory) continue;
    const directory = entry as FileSystemDirectoryEntry;
    return setIn(entry.name, (path) => new Promise((resolve, reject) => {
      const missing = (): void => reject(new Error(`${path} is not in the folder`));
      directory.getFile(path, {}, (file) => (file as FileSystemFileEntry).file(resolve, missing), missing);
    }));
  }
  return null;
}
