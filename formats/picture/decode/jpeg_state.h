// libjpeg, whose errors leave by longjmp: functions that they may leave hold nothing that needs a destructor,
// so everything is in a state outside of them. Internal to this room.
#pragma once

#include <csetjmp>
#include <cstdio>
// jpeglib.h needs stdio.h.
#include <jpeglib.h>

#include <array>
#include <string>

#include "formats/picture/decode/jpeg_markers.h"
#include "formats/picture/decode/picture_decoders.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// Each takes time for all pixels, however few bytes it has. Writers make about ten.
constexpr int kMostJpegScans = 100;

struct JpegState {
    jpeg_decompress_struct jpeg = {};
    jpeg_error_mgr errors = {};
    std::jmp_buf back;
    std::array<char, JMSG_LENGTH_MAX> error = {};
    int error_code = 0;
    std::array<char, JMSG_LENGTH_MAX> warning = {};  ///< the first

    JpegState();
    ~JpegState() { jpeg_destroy_decompress(&jpeg); }
    JpegState(const JpegState&) = delete;
    JpegState& operator=(const JpegState&) = delete;

    /// Returns whether `step` came to its end; its errors end it. Warnings that pixels are lost are errors.
    bool guarded(void (*step)(JpegState&));
    /// After the header: ink stays ink, all else becomes grey or RGB. In a step.
    void choose_output();
    /// The error that has ended a step. Throws std::bad_alloc if it was that.
    Error broken(const std::string& path) const;
    /// What a person should know of damage that has lost no pixels, or "".
    std::string damage() const;
};

/// Throws Error: kUnsupported for kinds of JPEG that are not read, kBadFile for sizes over the limits.
void check_jpeg_frame(const std::string& path, const JpegMarkers& markers, const ImageLimits& limits);

/// What the markers say about colours.
StatedColor stated_color(const JpegMarkers& markers);

/// The four channels are inks, which Adobe's writers, and all who follow them, store upside down.
void name_inks(DecodedPicture& picture, bool upside_down);

}  // namespace imgmesh
