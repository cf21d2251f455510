// Which vertices may change at the same time.
#pragma once

#include <span>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The vertices of each square tile of the image. Tiles are in classes: no face has vertices in two tiles of
/// a class. So the tiles of a class may be handled at the same time, and the outcome is that of one after the
/// other. What a thread reads is near what it has just read.
class VertexTiles {
  public:
    /// Faces with kNone as corners are left out, and so are vertices without a face.
    VertexTiles(std::span<const Face> faces, std::span<const Vec2f> position);

    /// Calls work(v) once for each vertex, for those of a tile in the order of their numbers.
    template <class Work>
    void for_each(Work&& work) const {
        for (const std::vector<Id>& tiles : classes_)
            parallel_blocks(0, static_cast<int>(tiles.size()), 1, [&](int begin, int end) {
                for (int k = begin; k < end; ++k)
                    for (const Id v : members_[tiles[static_cast<std::size_t>(k)]]) work(v);
            });
    }

    const std::vector<std::vector<Id>>& members() const { return members_; }  ///< of each tile
    const std::vector<std::vector<Id>>& classes() const { return classes_; }  ///< the tiles of each class

  private:
    std::vector<std::vector<Id>> members_, classes_;
};

}  // namespace imgmesh
