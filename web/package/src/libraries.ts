// Libraries of JavaScript that stand in the engine for those of C and C++ (web/ports/script_libraries.h): fflate for
// libdeflate, @noble/hashes for OpenSSL, draco3d for Draco.
import { sha256 } from "@noble/hashes/sha2.js";
import { unzlibSync, zlibSync } from "fflate";
import { loadedDraco, type DracoCoder } from "./draco.js";

export interface Libraries {
  zlib: {
    pack(bytes: Uint8Array, level: number): Uint8Array;
    /** Exactly `size` bytes, or null if there are more or fewer or the bytes are broken. */
    unpack(bytes: Uint8Array, size: number): Uint8Array | null;
  };
  sha256: { create(): { update(bytes: Uint8Array): unknown; digest(): Uint8Array } };
  draco: { loaded(): DracoCoder | null };
}

type Level = 0 | 1 | 2 | 3 | 4 | 5 | 6 | 7 | 8 | 9;

export const libraries: Libraries = {
  zlib: {
    pack: (bytes, level) => zlibSync(bytes, { level: level as Level }),
    unpack(bytes, size) {
      try {
        // What does not fit is dropped, so one byte more of room shows it.
        const out = unzlibSync(bytes, { out: new Uint8Array(size + 1) });
        return out.length === size ? out : null;
      } catch {
        return null;
      }
    },
  },
  sha256,
  draco: { loaded: loadedDraco },
};
