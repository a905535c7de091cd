// The decoded tiles of a map by name, such as "17/68000/42000".

const MOST = 400;

/**
 * Images that are decoded as they come; `decoded()` is called when there is one more.
 *
 * @param {() => void} decoded
 */
export function makeImages(decoded) {
  /** @type {Map<string, {data: string, image: ImageBitmap | null}>} */
  const tiles = new Map(); // null while it is decoded, and without one

  return {
    /** @param {string} name */
    has: (name) => tiles.has(name),
    /** @param {string} name */
    imageOf: (name) => tiles.get(name)?.image,
    /**
     * @param {string} name
     * @param {string} data as base64, "" without an image
     */
    async add(name, data) {
      if (tiles.get(name)?.data === data) return;
      /** @type {{data: string, image: ImageBitmap | null}} */
      const tile = { data, image: null };
      tiles.set(name, tile);
      for (const [oldest, { image }] of tiles) {
        if (tiles.size <= MOST) break;
        image?.close();
        tiles.delete(oldest);
      }
      if (!data) return;
      const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
      try {
        tile.image = await createImageBitmap(new Blob([bytes]));
      } catch {
        return; // the server has read it, the browser cannot
      }
      decoded();
    },
    clear() {
      for (const { image } of tiles.values()) image?.close();
      tiles.clear();
    },
  };
}
