#include "formats/picture/codecs/codec_types.h"

#include "formats/picture/codecs/color_wire.h"

namespace imgmesh {
namespace {

void put(WireWriter& out, const std::vector<std::string>& texts) {
    out.number(std::uint64_t{texts.size()});
    for (const std::string& text : texts) out.text(text);
}

std::vector<std::string> take_texts(WireReader& in) {
    std::vector<std::string> texts;
    // Every text takes bytes, so a wrong count soon meets the end.
    for (auto count = in.number<std::uint64_t>(); count > 0; --count) texts.push_back(in.text());
    return texts;
}

template <typename Value>
Value complete(const WireReader& in, Value value) {
    if (in.left() != 0) throw std::runtime_error("a message that is too long");
    return value;
}

template <typename Enum>
Enum take_enum(WireReader& in, Enum last) {
    const auto value = in.number<std::uint32_t>();
    if (value > static_cast<std::uint32_t>(last)) throw std::runtime_error("a message with a wrong value");
    return static_cast<Enum>(value);
}

template <typename Enum>
void put_enum(WireWriter& out, Enum value) {
    out.number(static_cast<std::uint32_t>(value));
}

}  // namespace

std::vector<std::uint8_t> wire_from(const DecodeTask& task) {
    WireWriter out;
    out.text(task.path);
    put_enum(out, task.claim.format);
    for (const std::int64_t number :
         {task.claim.width, task.claim.height, task.claim.channels, task.limits.max_pixels,
          std::int64_t{task.limits.max_side}, std::int64_t{task.limits.max_channels},
          task.limits.max_pixels_per_byte})
        out.number(number);
    return out.result();
}

DecodeTask decode_task_from(std::span<const std::uint8_t> wire) {
    WireReader in(wire);
    DecodeTask task;
    task.path = in.text();
    task.claim.format = take_enum(in, PictureFormat::kHeif);
    task.claim.width = in.number<std::int64_t>();
    task.claim.height = in.number<std::int64_t>();
    task.claim.channels = in.number<std::int64_t>();
    task.limits.max_pixels = in.number<std::int64_t>();
    task.limits.max_side = static_cast<int>(in.number<std::int64_t>());
    task.limits.max_channels = static_cast<int>(in.number<std::int64_t>());
    task.limits.max_pixels_per_byte = in.number<std::int64_t>();
    return complete(in, std::move(task));
}

std::vector<std::uint8_t> wire_from(const CodecPicture& picture) {
    WireWriter out;
    put(out, picture.channel_names);
    out.number(std::uint8_t{picture.associated_alpha});
    out.number(picture.orientation);
    put_color(out, picture.color);
    put(out, picture.warnings);
    return out.result();
}

CodecPicture codec_picture_from(std::span<const std::uint8_t> wire) {
    WireReader in(wire);
    CodecPicture picture;
    picture.channel_names = take_texts(in);
    picture.associated_alpha = in.number<std::uint8_t>() != 0;
    picture.orientation = in.number<int>();
    picture.color = take_color(in);
    picture.warnings = take_texts(in);
    return complete(in, std::move(picture));
}

std::vector<std::uint8_t> wire_from(const EncodeTask& task) {
    WireWriter out;
    for (const std::string* text : {&task.path, &task.writer, &task.extension}) out.text(*text);
    out.number(task.width);
    out.number(task.height);
    put(out, task.channel_names);
    out.number(task.alpha_channel);
    put_enum(out, task.type);
    out.number(std::uint8_t{task.say_srgb});
    out.bytes(task.icc);
    return out.result();
}

EncodeTask encode_task_from(std::span<const std::uint8_t> wire) {
    WireReader in(wire);
    EncodeTask task;
    for (std::string* text : {&task.path, &task.writer, &task.extension}) *text = in.text();
    task.width = in.number<int>();
    task.height = in.number<int>();
    task.channel_names = take_texts(in);
    task.alpha_channel = in.number<int>();
    task.type = take_enum(in, SampleType::kFloat);
    task.say_srgb = in.number<std::uint8_t>() != 0;
    task.icc = in.bytes();
    return complete(in, std::move(task));
}

std::vector<std::uint8_t> wire_from(const TextTask& task) {
    WireWriter out;
    for (const int number : {task.width, task.height, task.channels}) out.number(number);
    out.number(std::uint64_t{task.labels.size()});
    for (const TextLabel& label : task.labels) {
        for (const int number : {label.x, label.y, label.size}) out.number(number);
        put_enum(out, label.align);
        for (int c = 0; c < 3; ++c) out.number(label.color[c]);
        out.text(label.text);
    }
    return out.result();
}

TextTask text_task_from(std::span<const std::uint8_t> wire) {
    WireReader in(wire);
    TextTask task;
    for (int* number : {&task.width, &task.height, &task.channels}) *number = in.number<int>();
    for (auto count = in.number<std::uint64_t>(); count > 0; --count) {
        TextLabel& label = task.labels.emplace_back();
        for (int* number : {&label.x, &label.y, &label.size}) *number = in.number<int>();
        label.align = take_enum(in, TextAlign::kRight);
        for (int c = 0; c < 3; ++c) label.color[c] = in.number<float>();
        label.text = in.text();
    }
    return complete(in, std::move(task));
}

}  // namespace imgmesh
