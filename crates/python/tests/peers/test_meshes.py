"""Meshes of trimesh, pyvista, meshio and Open3D are drawn as what they are: shape, colours, images, numbers, scenes."""

import importlib
from pathlib import Path

import numpy as np
import pytest

import halfway

ASSETS = Path(__file__).resolve().parents[4] / "assets"
FRONT = {"size": (64, 64), "view": "front", "shading": "unlit", "background": "black"}
RED, GREEN, WHITE, BLUE = [255, 0, 0], [0, 255, 0], [255, 255, 255], [0, 0, 255]


def package(name):
    """A package, where it is installed and loads."""
    try:
        return importlib.import_module(name)
    except (ImportError, OSError) as error:
        pytest.skip(f"{name}: {error}")


def quarters(picture):
    """The colours in the middle of the four quarters of a square: upper left, upper right, lower left, lower right."""
    return [picture[row, column, :3].tolist() for row, column in ((18, 18), (18, 46), (46, 18), (46, 46))]


@pytest.fixture
def square(tmp_path):
    """A square with an image whose quarters differ, as an OBJ file."""
    image = np.full((64, 64, 3), 255, np.uint8)
    image[:32, :32], image[:32, 32:], image[32:, 32:] = RED, GREEN, BLUE
    halfway.Picture(image).save(tmp_path / "image.png")
    (tmp_path / "square.mtl").write_text("newmtl m\nKd 1 1 1\nmap_Kd image.png\n")
    (tmp_path / "square.obj").write_text(
        "mtllib square.mtl\nusemtl m\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
    return tmp_path / "square.obj"


def test_images_lie_as_in_the_file(square):
    assert quarters(halfway.render(square, **FRONT)) == [RED, GREEN, WHITE, BLUE]


class TestTrimesh:
    @pytest.fixture(autouse=True)
    def _package(self):
        self.trimesh = package("trimesh")

    def test_shape(self):
        ball = self.trimesh.creation.icosphere(subdivisions=3)
        same = halfway.render(np.array(ball.vertices), np.array(ball.faces), size=(80, 60))
        assert np.array_equal(halfway.render(ball, size=(80, 60)), same)

    def test_images(self, square):
        loaded = self.trimesh.load(square, force="mesh")
        assert quarters(halfway.render(loaded, **FRONT)) == [RED, GREEN, WHITE, BLUE]

    def test_colors_of_vertices_and_of_faces(self):
        quad = self.trimesh.Trimesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]], process=False)
        quad.visual.vertex_colors = [[255, 0, 0, 255]] * 4
        by_vertices = halfway.render(quad, **FRONT)[32, 32]
        quad.visual = self.trimesh.visual.ColorVisuals(quad, face_colors=[[255, 0, 0, 255], [0, 0, 255, 255]])
        by_faces = halfway.render(quad, **FRONT)
        assert by_vertices[0] > 200 and by_vertices[1] == by_vertices[2] == 0
        assert by_faces[46, 46].tolist() == by_vertices.tolist() and by_faces[18, 18, 2] > 200 and by_faces[18, 18, 0] == 0

    def test_scenes_have_places_and_materials(self):
        loaded = self.trimesh.load(ASSETS / "lantern.glb")
        scene = halfway.Scene(loaded)
        assert len(scene.objects) == len(loaded.graph.nodes_geometry)
        assert {tuple(np.round(entry.get("material")["diffuse"], 3)) for entry in scene.objects} != {(0.0, 0.0, 0.0)}
        size = {"size": (80, 60), "outputs": ["id"]}
        ours, theirs = (halfway.render(source, **size)["id"] > 0 for source in (ASSETS / "lantern.glb", loaded))
        assert (ours != theirs).mean() < 0.01

    def test_what_has_no_faces_in_a_scene_is_said(self):
        scene = self.trimesh.Scene([self.trimesh.creation.box(), self.trimesh.PointCloud(np.random.rand(9, 3))])
        with pytest.warns(halfway.SceneWarning, match="PointCloud without faces, is not shown"):
            assert len(halfway.Scene(scene).objects) == 1
        with pytest.raises(TypeError, match="mesh: PointCloud; expected vertices and faces"):
            halfway.render(self.trimesh.PointCloud(np.random.rand(9, 3)))

    def test_materials_of_gltf(self):
        box = self.trimesh.creation.box()
        glass = self.trimesh.visual.material.PBRMaterial(baseColorFactor=[255, 0, 0, 128], metallicFactor=0.0,
                                                         roughnessFactor=0.5, alphaMode="BLEND", doubleSided=True)
        box.visual = self.trimesh.visual.TextureVisuals(material=glass)
        (entry,) = halfway.Scene(box).objects
        material = entry.get("material")
        assert material["diffuse"] == [1, 0, 0] and material["shininess"] == 30 and entry.get("faces") == "both"
        assert entry.get("blend") is True and material["opacity"] == pytest.approx(128 / 255)


class TestPyvista:
    @pytest.fixture(autouse=True)
    def _package(self, recwarn):
        self.pyvista = package("pyvista")
        recwarn.clear()
        yield
        assert not [warning for warning in recwarn if "pyvista" in str(warning.category).lower()]

    def test_shape(self):
        drawn = halfway.render(self.pyvista.Cube(), size=(64, 64), outputs=["face_normal", "id"])
        assert len(np.unique(drawn["face_normal"][drawn["id"] > 0].round(3), axis=0)) == 3

    def test_grids_show_their_surface(self):
        grid = self.pyvista.ImageData(dimensions=(4, 4, 4))
        of_cells = grid.cast_to_unstructured_grid()
        size = {"size": (64, 64), "outputs": ["depth"]}
        assert np.array_equal(halfway.render(grid, **size)["depth"], halfway.render(of_cells, **size)["depth"])
        both = self.pyvista.MultiBlock([grid, self.pyvista.Sphere(center=(8, 0, 0))])
        assert (halfway.render(both, **size)["depth"] > 0).any()

    def test_numbers(self):
        plane = self.pyvista.Plane(i_size=2, j_size=2, i_resolution=1, j_resolution=1)
        plane.point_data["height"] = [0.0, 0.0, 1.0, 1.0]
        plane.cell_data["kind"] = [3]
        mesh = halfway.Scene(plane)._meshes[0]
        assert {"height", "kind"} <= set(mesh.properties)
        picture = halfway.render(plane, scalars="height", map="viridis", size=(64, 64), view="top", up="z", shading="unlit")
        assert picture[50, 32, 2] > picture[14, 32, 2]

    def test_colors(self):
        plane = self.pyvista.Plane(i_size=2, j_size=2, i_resolution=1, j_resolution=1)
        plane.point_data["rgb"] = np.array([[255, 0, 0]] * 4, np.uint8)
        plane.set_active_scalars("rgb")
        color = halfway.render(plane, **FRONT)[32, 32]
        assert color[0] > 200 and color[1] == color[2] == 0
        plane.set_active_scalars(None)
        assert len(set(halfway.render(plane, **FRONT)[32, 32, :3].tolist())) == 1

    def test_both_sides_are_shown(self):
        assert (halfway.render(self.pyvista.Plane(direction=(0, 0, -1)), **FRONT)[32, 32, :3] > 0).all()

    def test_points_alone_are_an_error(self):
        with pytest.raises(ValueError, match="without faces"):
            halfway.render(self.pyvista.PolyData(np.random.rand(9, 3)))


class TestMeshio:
    @pytest.fixture(autouse=True)
    def _package(self):
        self.meshio = package("meshio")

    POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]

    @pytest.mark.parametrize(("kind", "cell", "triangles"), [
        ("triangle", [0, 1, 2], 1), ("quad", [0, 1, 2, 3], 2), ("tetra", [0, 1, 3, 4], 4), ("pyramid", [0, 1, 2, 3, 4], 6),
        ("wedge", [0, 1, 3, 4, 5, 7], 8), ("hexahedron", [0, 1, 2, 3, 4, 5, 6, 7], 12),
    ])
    def test_kinds_of_cells(self, kind, cell, triangles):
        mesh = halfway.Scene(self.meshio.Mesh(self.POINTS, [(kind, [cell])]))._meshes[0]
        assert len(mesh.faces) == triangles
        if triangles >= 4:
            # All sides face outward: the volume is above 0, the cell's.
            a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
            volume = (np.cross(a, b) * c).sum() / 6
            assert volume == pytest.approx({4: 1 / 6, 6: 1 / 3, 8: 1 / 2, 12: 1}[triangles], abs=1e-6)

    def test_sides_between_cells_are_left_out(self):
        points = [*self.POINTS, *([x, y, z + 1] for x, y, z in self.POINTS[4:])]
        cells = [("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]])]
        mesh = self.meshio.Mesh(points, cells, cell_data={"layer": [[1.0, 2.0]]})
        drawn = halfway.Scene(mesh)._meshes[0]
        assert len(drawn.faces) == 20 and drawn.properties == ["layer"]

    def test_numbers_of_points_and_cells(self):
        mesh = self.meshio.Mesh(self.POINTS[:4], [("quad", [[0, 1, 2, 3]])], point_data={"t": [0.0, 1, 2, 3]},
                                cell_data={"c": [[1.0]]})
        assert set(halfway.Scene(mesh)._meshes[0].properties) == {"t", "c"}
        picture = halfway.render(mesh, scalars="t", range=(0, 3), **FRONT)
        assert picture[18, 18].tolist() != picture[46, 46].tolist()

    def test_points_on_edges_and_flat_points(self):
        corners = [[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]]
        mesh = halfway.Scene(self.meshio.Mesh(corners, [("triangle6", [[0, 1, 2, 3, 4, 5]])]))._meshes[0]
        assert mesh.faces.tolist() == [[0, 1, 2]]

    def test_lines_alone_are_an_error(self):
        with pytest.raises(ValueError, match="mesh: line; expected cells of triangle"):
            halfway.render(self.meshio.Mesh(self.POINTS, [("line", [[0, 1]])]))


class TestOpen3D:
    @pytest.fixture(autouse=True)
    def _package(self):
        self.open3d = package("open3d")

    def test_shape_and_normals(self):
        ball = self.open3d.geometry.TriangleMesh.create_sphere()
        ball.compute_vertex_normals()
        picture = halfway.render(ball, size=(80, 60), outputs=["normal", "depth"])
        assert (picture["depth"] > 0).mean() > 0.2

    def test_colors(self):
        box = self.open3d.geometry.TriangleMesh.create_box()
        box.paint_uniform_color([1, 0, 0])
        color = halfway.render(box, **FRONT)[32, 32]
        assert color[0] > 200 and color[1] == color[2] == 0

    def test_images(self, square):
        loaded = self.open3d.io.read_triangle_mesh(str(square), True)
        assert quarters(halfway.render(loaded, **FRONT)) == [RED, GREEN, WHITE, BLUE]

    def test_tensor_meshes(self):
        ball = self.open3d.geometry.TriangleMesh.create_sphere()
        tensor = self.open3d.t.geometry.TriangleMesh.from_legacy(ball)
        assert np.array_equal(halfway.render(tensor, size=(48, 48)), halfway.render(ball, size=(48, 48)))

    def test_points_alone_are_an_error(self):
        with pytest.raises(TypeError, match="mesh: PointCloud; expected"):
            halfway.render(self.open3d.geometry.PointCloud())
