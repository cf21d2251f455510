// write_image: what is read back, what is refused, and that no failed write leaves a file.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>

#include "formats/picture/image_io.h"
#include "libcore/image/color.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

TEST_CASE("write: integer codes come back exactly from every lossless format") {
    const TemporaryFolder folder;
    for (const std::string name : {"a.png", "a.tif", "a.TIFF", "a.webp", "a.bmp", "a.ppm", "a.pnm",
                                   "mit Leerzeichen \xC3\xA4 \xE6\x97\xA5.png"}) {
        for (const int channels : {1, 2, 3, 4}) {
            INFO(name << " " << channels << " channels");
            const Image image = random_picture(11, 6, channels);
            const bool alpha = channels == 2 || channels == 4;
            const std::string path = folder / name;
            const bool holds_alpha = path.find(".bmp") == std::string::npos &&
                                     path.find("nm") == std::string::npos &&
                                     path.find(".pp") == std::string::npos;
            if (alpha && !holds_alpha) {
                CHECK(error_of([&] { write_image(path, image); }) == ErrorKind::kBadArgument);
                continue;
            }
            write_image(path, image);
            const Image back = read_image(path);
            CHECK(back.sample_type == SampleType::kUint8);
            CHECK(back.color_space == ColorSpace::kSrgb);
            if (path.ends_with(".webp") && channels < 3) {  // WebP knows no grey
                CHECK(back.channels == channels + 2);
                CHECK(back.pixel(3, 3)[1] == image.pixel(3, 3)[0]);
            } else if (path.ends_with(".bmp") && channels == 1) {
                CHECK(back.pixel(3, 3)[0] == image.pixel(3, 3)[0]);
            } else {
                CHECK(max_difference(back, image) == 0);
                CHECK(back.channel_names == image.channel_names);
            }
        }
    }
    for (const std::string name : {"b.png", "b.tif"}) {
        INFO(name);
        Image image = random_picture(11, 6, 3, 65535);
        image.sample_type = SampleType::kUint16;
        write_image(folder / name, image);
        CHECK(max_difference(read_image(folder / name), image) == 0);
        CHECK(read_image(folder / name).sample_type == SampleType::kUint16);
    }
}

TEST_CASE("write: floats come back from EXR and TIFF, with alpha and any channels") {
    const TemporaryFolder folder;
    Image image = random_picture(8, 5, 5);
    image.sample_type = SampleType::kFloat;
    image.color_space = ColorSpace::kLinear;
    image.channel_names = {"R", "G", "B", "A", "Z"};
    image.data[4] = 1e6f;
    image.data[5] = -3.5f;
    for (float& x : image.data) x += 0.01f;  // no zero alpha, which hides its colour
    for (const std::string name : {"f.exr", "f.tif"}) {
        INFO(name);
        write_image(folder / name, image);
        const Image back = read_image(folder / name);
        CHECK(back.color_space == ColorSpace::kLinear);
        for (std::size_t i = 0; i < image.data.size(); ++i)
            CHECK(back.data[i] == doctest::Approx(image.data[i]).epsilon(1e-6));
    }
    write_image(folder / "f.exr", image, {.overwrite = true, .sample_type = SampleType::kHalf});
    CHECK(read_image(folder / "f.exr").sample_type == SampleType::kHalf);
    CHECK(read_image(folder / "f.exr").channel_names == image.channel_names);
    CHECK(read_image(folder / "f.exr").data[4] <= 65504);  // the largest half, not infinity
}

// The format may change the numbers; the light stays.
TEST_CASE("write: colour spaces are noted or converted, and colours stay") {
    const TemporaryFolder folder;
    for (const ColorSpace space : {ColorSpace::kSrgb, ColorSpace::kLinear, ColorSpace::kRec709,
                                   ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3}) {
        for (const SampleType type : {SampleType::kUint16, SampleType::kFloat}) {
            for (const std::string name : {"c.png", "c.tif", "c.exr", "c.jpg", "c.webp", "c.ppm"}) {
                INFO(name << " " << color_space_name(space) << " " << static_cast<int>(type));
                Image image = make_image(16, 16, 3);
                for (std::size_t i = 0; i < image.data.size(); i += 3) {
                    image.data[i] = 0.5f;
                    image.data[i + 1] = 0.4f;
                    image.data[i + 2] = 0.45f;
                }
                image.color_space = space;
                image.sample_type = type;
                write_image(folder / name, image);
                const Image back = read_image(folder / name);
                const Vec3f expected = luv_from_linear(linear_from_encoded(space, Vec3f(0.5f, 0.4f, 0.45f)));
                const float* p = back.pixel(8, 8);
                const Vec3f found =
                    luv_from_linear(linear_from_encoded(back.color_space, Vec3f(p[0], p[1], p[2])));
                CHECK((found - expected).norm() < (name == "c.jpg" ? 1.2f : 0.6f));  // codes of 8 bits
                if (type == SampleType::kUint16 && (name == "c.png" || name == "c.tif"))
                    CHECK(back.color_space == space);
            }
        }
    }
    Image grey = random_picture(4, 4, 1);  // no RGB profile fits it
    grey.color_space = ColorSpace::kAdobeRgb;
    write_image(folder / "g.png", grey);
    CHECK(read_image(folder / "g.png").color_space == ColorSpace::kSrgb);
}

TEST_CASE("write: rounds to the nearest code and clamps") {
    const TemporaryFolder folder;
    Image image = make_image(4, 1, 1);
    image.data = {-0.5f, 1.5f, 100.4f / 255, 100.6f / 255};
    write_image(folder / "r.png", image);
    const Image back = read_image(folder / "r.png");
    CHECK(std::lround(back.data[0] * 255) == 0);
    CHECK(std::lround(back.data[1] * 255) == 255);
    CHECK(std::lround(back.data[2] * 255) == 100);
    CHECK(std::lround(back.data[3] * 255) == 101);
}

TEST_CASE("write: an opaque alpha is left out where the format has none, transparency is refused") {
    const TemporaryFolder folder;
    Image image = random_picture(4, 4, 4);
    for (std::size_t i = 3; i < image.data.size(); i += 4) image.data[i] = 1;
    write_image(folder / "o.jpg", image);
    CHECK(read_image(folder / "o.jpg").channels == 3);
    image.data[7] = 0.5f;
    std::string text;
    CHECK(error_of([&] { write_image(folder / "t.jpg", image); }, &text) == ErrorKind::kBadArgument);
    CHECK(text.find("transparency") != std::string::npos);
    CHECK(folder.count() == 1);
}

TEST_CASE("write: what the format cannot hold is refused, and leaves nothing") {
    const TemporaryFolder folder;
    const Image image = random_picture(4, 4, 3);
    for (const std::string name : {"a.xyz", "a", "a.gltf", ".png"})
        CHECK(error_of([&] { write_image(folder / name, image); }) == ErrorKind::kBadArgument);
    const auto as = [&](const char* name, SampleType type) {
        return error_of([&] { write_image(folder / name, image, {.overwrite = true, .sample_type = type}); });
    };
    CHECK(as("a.png", SampleType::kFloat) == ErrorKind::kBadArgument);
    CHECK(as("a.jpg", SampleType::kUint16) == ErrorKind::kBadArgument);
    CHECK(as("a.exr", SampleType::kUint8) == ErrorKind::kBadArgument);
    CHECK(error_of([&] { write_image(folder / "a.png", random_picture(4, 4, 5)); }) ==
          ErrorKind::kBadArgument);
    CHECK(error_of([&] { write_image(folder / "a.webp", random_picture(16384, 1, 3)); }) ==
          ErrorKind::kBadArgument);
    CHECK(error_of([&] { write_image(folder / "a.jpg", random_picture(65536, 1, 3)); }) ==
          ErrorKind::kBadArgument);
    CHECK(folder.count() == 0);
    CHECK(can_write_image("x/y.PNG"));
    CHECK_FALSE(can_write_image("x/y.glb"));
}

TEST_CASE("write: the same image gives the same bytes") {
    const TemporaryFolder folder;
    const Image image = random_picture(20, 10, 3);
    for (const std::string name : {"s.png", "s.jpg", "s.tif", "s.webp", "s.exr", "s.bmp", "s.ppm"}) {
        INFO(name);
        write_image(folder / name, image);
        const auto first = load(folder / name);
        CHECK(first.size() > 10);
        if (name == "s.tif") {  // OpenImageIO would note the second
            struct timespec second = {1, 100000000};
            ::nanosleep(&second, nullptr);
        }
        write_image(folder / name, image);
        CHECK(load(folder / name) == first);
    }
}

// The limit on a file's size simulates a full disk: both fail in write().
TEST_CASE("write: a full disk, a missing folder and an existing file are errors that leave nothing") {
    const TemporaryFolder folder;
    const Image image = random_picture(100, 100, 3);
    struct rlimit old = {};
    ::getrlimit(RLIMIT_FSIZE, &old);
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    struct rlimit small = old;
    small.rlim_cur = 1000;
    for (const std::string name : {"d.png", "d.jpg", "d.tif", "d.webp", "d.exr", "d.bmp", "d.ppm"}) {
        INFO(name);
        ::setrlimit(RLIMIT_FSIZE, &small);
        const std::optional<ErrorKind> code = error_of([&] { write_image(folder / name, image); });
        ::setrlimit(RLIMIT_FSIZE, &old);
        CHECK(code == ErrorKind::kIo);
    }
    ::signal(SIGXFSZ, handler);
    CHECK(folder.count() == 0);
    CHECK(error_of([&] { write_image(folder / "no/a.png", image); }) == ErrorKind::kIo);

    save(folder / "e.png", {1, 2, 3});
    CHECK(error_of([&] { write_image(folder / "e.png", image, {.overwrite = false, .sample_type = {}}); }) ==
          ErrorKind::kIo);
    CHECK(load(folder / "e.png") == std::vector<std::uint8_t>{1, 2, 3});
}
