"""Other formats' programs, which know a quality, driven to a number of bytes."""
import dataclasses
import struct
import typing

from PIL import Image

from bench_process import BenchError, run


def avif_payload(path):
    """Bytes of the coded picture in an AVIF file (the box mdat), which does not count the other boxes."""
    data, at = path.read_bytes(), 0
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"mdat":
            return size - 8
        at += size
    raise BenchError(f"{path}: no box mdat")


def file_bytes(path):
    return path.stat().st_size


@dataclasses.dataclass(frozen=True)
class Peer:
    """A format: the package of its programs, their commands with names in braces for files and quality, and the qualities."""
    name: str
    package: str
    extension: str
    encode: str
    decode: str
    qualities: tuple  # by rising size
    measure: typing.Callable = file_bytes

    def encoded(self, png, quality):
        """The file beside the PNG and the PPM of the picture; made once."""
        path = png.with_name(f"{png.stem}-{quality}.{self.extension}")
        if not path.exists():
            run_words(self.encode, quality=quality, png=png, ppm=png.with_suffix(".ppm"), file=path)
        return path

    def decoded(self, path):
        out = path.with_name(f"{path.name}.{'ppm' if '{ppm}' in self.decode else 'png'}")
        run_words(self.decode, file=path, ppm=out, png=out)
        image = Image.open(out).convert("RGB")
        out.unlink()
        return image

    def within(self, png, limit):
        """The quality of the largest file of at most `limit` bytes, or None."""
        return last_within(self.qualities, lambda quality: self.measure(self.encoded(png, quality)), limit)


def last_within(values, size, limit):
    """The last of `values`, which come by rising size, whose size is at most `limit`, or None. Where sizes do not quite
    rise, it is one that is followed by a larger size."""
    low, high = 0, len(values)  # values before low are within, those from high on are not
    while low < high:
        middle = (low + high) // 2
        if size(values[middle]) <= limit:
            low = middle + 1
        else:
            high = middle
    return values[low - 1] if low else None


def run_words(command, **names):
    run([word.format(**names) for word in command.split()])


JPEG = Peer("JPEG", "libjpeg-turbo-progs", "jpg", "cjpeg -progressive -optimize -quality {quality} -outfile {file} {ppm}",
            "djpeg -outfile {ppm} {file}", tuple(range(1, 101)))
WEBP = Peer("WebP", "webp", "webp", "cwebp -quiet -m 6 -q {quality} {png} -o {file}", "dwebp -quiet {file} -o {png}",
            tuple(q / 2 for q in range(201)))
AVIF = Peer("AVIF", "libavif-bin", "avif",
            "avifenc -j 1 --speed 3 --yuv 420 --min {quality} --max {quality} {png} {file}", "avifdec -j 1 {file} {png}",
            tuple(range(63, -1, -1)))
# Distances from 25, the largest, in steps of 6 %.
JXL = Peer("JPEG XL", "libjxl-tools", "jxl", "cjxl --quiet --num_threads=0 -d {quality} {png} {file}",
           "djxl --quiet --num_threads=0 {file} {png}", tuple(round(25 * 2 ** (-k / 12), 3) for k in range(97)))
PEERS = {peer.name: peer for peer in (JPEG, WEBP, AVIF, JXL)}
AVIF_PAYLOAD = dataclasses.replace(AVIF, name="AVIF, payload", measure=avif_payload)
LOSSLESS = {"WebP": "cwebp -quiet -z 9 {png} -o {file}", "JPEG XL": "cjxl --quiet --num_threads=0 -d 0 {png} {file}"}
