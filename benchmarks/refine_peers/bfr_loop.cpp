// A view's tessellation of Loop's limit surface by OpenSubdiv's Bfr, from nothing each time:
// bfr_loop MESH EYE_X EYE_Y EYE_Z PIXELS_PER_RADIAN EDGE_PIXELS
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <memory>

#include "peer.h"

using namespace OpenSubdiv;
using Surface = Bfr::Surface<double>;

// Pieces that an edge is cut in: one where no face at it faces the eye.
static int rateOf(Mesh const &mesh, View const &view, Far::TopologyLevel const &level, int edge) {
    auto corner = [&](int v) { return &mesh.positions[3 * v]; };
    auto sides = level.GetEdgeFaces(edge);
    bool isSeen = false;
    for (int i = 0; i < sides.size(); ++i) {
        int32_t const *f = &mesh.faces[3 * sides[i]];
        isSeen = isSeen || view.faces(corner(f[0]), corner(f[1]), corner(f[2]));
    }
    auto ends = level.GetEdgeVertices(edge);
    double excess = view.excess(corner(ends[0]), corner(ends[1]));
    return isSeen ? std::max(1, int(std::ceil(excess))) : 1;
}

int main(int, char **words) {
    Mesh mesh = readMesh(words[1]);
    View view = View::of(words + 2);
    Far::TopologyDescriptor described;
    std::vector<int> sizes(mesh.faceCount(), 3);
    described.numVertices = mesh.vertexCount();
    described.numFaces = mesh.faceCount();
    described.numVertsPerFace = sizes.data();
    described.vertIndicesPerFace = mesh.faces.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(described, Factory::Options(Sdc::SCHEME_LOOP, options)));
    auto level = refiner->GetLevel(0);

    return report([&] {
        Bfr::RefinerSurfaceFactory<> surfaces(*refiner);
        Surface surface;
        Surface::PointDescriptor triple(3);
        std::vector<double> patch, uvs, points;
        std::vector<int> facets;
        for (int f = 0; f < mesh.faceCount(); ++f) {
            if (!surfaces.InitVertexSurface(f, &surface)) continue;
            auto edges = level.GetFaceEdges(f);
            int rates[3];
            for (int k = 0; k < 3; ++k) rates[k] = rateOf(mesh, view, level, edges[k]);
            Bfr::Tessellation pattern(surface.GetParameterization(), 3, rates);
            patch.resize(3 * surface.GetNumPatchPoints());
            surface.PreparePatchPoints(mesh.positions.data(), triple, patch.data(), triple);
            int count = pattern.GetNumCoords();
            uvs.resize(2 * count);
            pattern.GetCoords(uvs.data());
            size_t begin = points.size(), first = facets.size();
            points.resize(begin + 3 * count);
            for (int i = 0; i < count; ++i)
                surface.Evaluate(&uvs[2 * i], patch.data(), triple, &points[begin + 3 * i]);
            facets.resize(first + 3 * pattern.GetNumFacets());
            pattern.GetFacets(&facets[first]);
            pattern.TransformFacetCoordIndices(&facets[first], int(begin / 3));
        }
        return long(facets.size() / 3);
    });
}
