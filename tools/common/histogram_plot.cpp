#include "tools/common/histogram_plot.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "libcore/base/error.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// Blue, orange, grey: colour-blind people can distinguish them too.
const std::array<Vec3f, 3> kColors = {Vec3f(0.20f, 0.42f, 0.66f), Vec3f(0.88f, 0.53f, 0.15f),
                                      Vec3f(0.42f, 0.42f, 0.42f)};
const Vec3f kInk(0.15f, 0.15f, 0.15f), kPale(0.85f, 0.85f, 0.85f);

// Sizes of the drawing and of a panel [pixels]. The width of the bars' area is a multiple of 20, because most
// histograms have 20 bins.
constexpr int kColumns = 3, kMargin = 14, kLegendRow = 20;
constexpr int kPanelWidth = 350, kPanelHeight = 240;
constexpr int kLeft = 50, kTop = 56, kBarsWidth = 280, kBarsHeight = 150;
constexpr int kTitleSize = 14, kTextSize = 11;

std::string percent(double share) {
    return format_number(100 * share, 3) + " %";
}

double share_of(std::int64_t part, const Distribution& d) {
    return d.count > 0 ? static_cast<double>(part) / static_cast<double>(d.count) : 0;
}

// Returns the least of these shares, or 1, that no bar exceeds.
double share_axis(const HistogramPanel& panel) {
    double top = 0;
    for (const HistogramSeries& s : panel.series)
        for (const std::int64_t count : s.distribution.histogram)
            top = std::max(top, share_of(count, s.distribution));
    for (const double step : {0.01, 0.02, 0.04, 0.06, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8})
        if (top <= step) return step;
    return 1;
}

// Draws one panel with its top left corner at (x0, y0).
class PanelWriter {
  public:
    PanelWriter(Plot& plot, const HistogramPanel& panel, int x0, int y0)
        : plot_(plot), panel_(panel), x_(x0 + kLeft), y_(y0 + kTop), axis_(share_axis(panel)) {}

    void write() {
        label(0, -kTop + 16, kTitleSize, TextAlign::kLeft, kInk, panel_.title);
        write_axes();
        for (std::size_t s = 0; s < panel_.series.size(); ++s) {
            write_bars(s);
            write_figures(s);
        }
    }

  private:
    void label(int x, int y, int size, TextAlign align, const Vec3f& color, const std::string& text) {
        plot_.labels.push_back({x_ + x, y_ + y, size, align, color, text});
    }
    void box(int x, int y, int width, int height, const Vec3f& color) {
        plot_.boxes.push_back({x_ + x, y_ + y, width, height, color});
    }

    void write_axes() {
        const Bins& bins = panel_.series.front().distribution.bins;
        for (int k = 0; k <= 2; ++k) {
            const int y = kBarsHeight - k * kBarsHeight / 2, x = k * kBarsWidth / 2;
            box(0, y, kBarsWidth, 1, k == 0 ? kInk : kPale);
            label(-6, y + 4, kTextSize, TextAlign::kRight, kInk, percent(axis_ * k / 2));
            label(x, kBarsHeight + 16, kTextSize, TextAlign::kCenter, kInk,
                  format_number(bins.low + (bins.high - bins.low) * k / 2));
        }
    }

    void write_bars(std::size_t s) {
        const Distribution& d = panel_.series[s].distribution;
        const auto series = static_cast<int>(panel_.series.size()), place = static_cast<int>(s);
        const int slots = d.bins.count * series;
        for (int bin = 0; bin < d.bins.count; ++bin) {
            const double share = share_of(d.histogram[static_cast<std::size_t>(bin)], d);
            const auto height = static_cast<int>(std::lround(share / axis_ * kBarsHeight));
            const int slot = bin * series + place;
            const int from = slot * kBarsWidth / slots, to = (slot + 1) * kBarsWidth / slots;
            // There is a gap between bins, and none between the bars of one bin.
            const int gap = place + 1 == series ? 1 : 0;
            if (height > 0) box(from, kBarsHeight - height, to - from - gap, height, color(s));
        }
    }

    // Writes mean and deviation, and how many values lie outside the bins.
    void write_figures(std::size_t s) {
        const Distribution& d = panel_.series[s].distribution;
        if (d.count == 0) return;
        std::string text =
            cat("mean ", format_number(d.mean), ", ", format_number(d.min), " to ", format_number(d.max));
        if (d.above > 0) text += cat("; ", percent(share_of(d.above, d)), " above ", d.bins.high);
        if (d.below > 0) text += cat("; ", percent(share_of(d.below, d)), " below ", d.bins.low);
        label(0, -kTop + 32 + 14 * static_cast<int>(s), kTextSize, TextAlign::kLeft, color(s), text);
    }

    Vec3f color(std::size_t s) const { return kColors[panel_.series[s].name]; }

    Plot& plot_;
    const HistogramPanel& panel_;
    int x_, y_;  // the bars' top left corner
    double axis_;
};

std::string hex(const Vec3f& color) {
    std::array<char, 8> text{};
    const auto byte = [&](int c) {
        return static_cast<unsigned>(std::lround(std::clamp(color[c], 0.0f, 1.0f) * 255));
    };
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(0), byte(1), byte(2));
    return text.data();
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else
            out += c;
    }
    return out;
}

const char* anchor(TextAlign align) {
    switch (align) {
        case TextAlign::kLeft:
            return "start";
        case TextAlign::kCenter:
            return "middle";
        case TextAlign::kRight:
            break;
    }
    return "end";
}

}  // namespace

Plot histogram_plot(const std::vector<std::string>& names, const std::vector<HistogramPanel>& panels) {
    assert(names.size() <= kColors.size());
    Plot plot;
    const int top = 2 * kMargin + kLegendRow * static_cast<int>(names.size());
    const int rows = (static_cast<int>(panels.size()) + kColumns - 1) / kColumns;
    const int columns = std::min(kColumns, static_cast<int>(panels.size()));
    plot.width = columns * kPanelWidth + kMargin;
    plot.height = top + rows * kPanelHeight;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const int y = kMargin + kLegendRow * static_cast<int>(i);
        plot.boxes.push_back({kMargin, y + 4, 12, 12, kColors[i]});
        plot.labels.push_back(
            {kMargin + 20, y + 15, kTitleSize, TextAlign::kLeft, kInk, printable_line(names[i])});
    }
    for (int i = 0; i < static_cast<int>(panels.size()); ++i)
        PanelWriter(plot, panels[static_cast<std::size_t>(i)], i % kColumns * kPanelWidth,
                    top + i / kColumns * kPanelHeight)
            .write();
    return plot;
}

std::string plot_svg(const Plot& plot) {
    std::string out = cat("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", plot.width, "\" height=\"",
                          plot.height, "\" viewBox=\"0 0 ", plot.width, ' ', plot.height,
                          "\" font-family=\"DejaVu Sans, sans-serif\">\n", "<rect width=\"", plot.width,
                          "\" height=\"", plot.height, "\" fill=\"#ffffff\"/>\n");
    for (const PlotBox& b : plot.boxes)
        out += cat("<rect x=\"", b.x, "\" y=\"", b.y, "\" width=\"", b.width, "\" height=\"", b.height,
                   "\" fill=\"", hex(b.color), "\"/>\n");
    for (const TextLabel& l : plot.labels)
        out += cat("<text x=\"", l.x, "\" y=\"", l.y, "\" font-size=\"", l.size, "\" text-anchor=\"",
                   anchor(l.align), "\" fill=\"", hex(l.color), "\">", escaped(l.text), "</text>\n");
    return out + "</svg>\n";
}

Image plot_boxes(const Plot& plot, int scale) {
    Image image = make_image(plot.width * scale, plot.height * scale, 3);
    std::fill(image.data.begin(), image.data.end(), 1.0f);
    for (const PlotBox& b : plot.boxes)
        for (int y = b.y * scale; y < (b.y + b.height) * scale; ++y)
            for (int x = b.x * scale; x < (b.x + b.width) * scale; ++x)
                std::copy_n(b.color.data(), 3, image.pixel(x, y));
    return image;
}

std::vector<TextLabel> plot_labels(const Plot& plot, int scale) {
    std::vector<TextLabel> labels = plot.labels;
    for (TextLabel& l : labels) {
        l.x *= scale;
        l.y *= scale;
        l.size *= scale;
    }
    return labels;
}

}  // namespace imgmesh
