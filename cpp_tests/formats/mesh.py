"""A mesh through the C interface, as numpy arrays: what files are compared with."""

import ctypes
import os

import numpy as np

FORMATS = {"vtu": 0, "msh": 1, "ism-v2": 2, "ism-mm": 3, "inp": 4, "mfem": 5, "svg": 6, "ism": 7}


def load(path):
    """The shared library with the types of what is used here."""
    library = ctypes.CDLL(os.fspath(path))
    pointer, text, number, size = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int32, ctypes.c_size_t
    result = {"quadrel_options_new": pointer, "quadrel_last_error_message": text, "quadrel_mesh_boundary_name": text}
    for name in ("order", "vertex_count", "element_count", "edge_count", "node_count", "boundary_count"):
        result[f"quadrel_mesh_{name}"] = number if name == "order" else size
    for name in ("elements", "element_boundaries", "edge_vertices", "edge_elements", "edge_boundaries", "element_nodes"):
        result[f"quadrel_mesh_{name}"] = ctypes.POINTER(number)
    for name in ("vertices", "nodes", "reference_nodes"):
        result[f"quadrel_mesh_{name}"] = ctypes.POINTER(ctypes.c_double)
    for name, kind in result.items():
        getattr(library, name).restype = kind
        getattr(library, name).argtypes = [pointer] if name.startswith("quadrel_mesh") else []
    library.quadrel_mesh_boundary_name.argtypes = [pointer, number]
    library.quadrel_domain_read.argtypes = [text, number, ctypes.POINTER(pointer)]
    library.quadrel_options_set_order.argtypes = [pointer, ctypes.c_int]
    library.quadrel_options_set_relative_tolerance.argtypes = [pointer, ctypes.c_double, number]
    library.quadrel_generate.argtypes = [pointer, pointer, pointer, ctypes.POINTER(pointer)]
    library.quadrel_mesh_write.argtypes = [pointer, number, text]
    for name in ("domain", "options", "mesh"):
        getattr(library, f"quadrel_{name}_free").argtypes = [pointer]
        getattr(library, f"quadrel_{name}_free").restype = None
    return library


class Mesh:
    """Generated from a file; nodes are [element][j][i], sides as in quadrel.h."""

    def __init__(self, library, path, order, relative):
        self._library = library
        domain, options, mesh = ctypes.c_void_p(), ctypes.c_void_p(library.quadrel_options_new()), ctypes.c_void_p()
        self._check(library.quadrel_domain_read(os.fspath(path).encode(), -1, ctypes.byref(domain)))
        self._check(library.quadrel_options_set_order(options, order))
        self._check(library.quadrel_options_set_relative_tolerance(options, relative, 0))
        self._check(library.quadrel_generate(domain, options, None, ctypes.byref(mesh)))
        library.quadrel_options_free(options)
        library.quadrel_domain_free(domain)
        self._mesh = mesh
        self.order = library.quadrel_mesh_order(mesh)
        row, faces = self.order + 1, library.quadrel_mesh_element_count(mesh)
        edges = library.quadrel_mesh_edge_count(mesh)
        self.reference = self._array("reference_nodes", row)
        self.vertices = self._array("vertices", library.quadrel_mesh_vertex_count(mesh), 2)
        self.elements = self._array("elements", faces, 4)
        self.nodes = self._array("nodes", library.quadrel_mesh_node_count(mesh), 2)[
            self._array("element_nodes", faces, row, row)
        ]
        self.side_boundaries = self._array("element_boundaries", faces, 4)
        self.edge_vertices = self._array("edge_vertices", edges, 2)
        self.edge_boundaries = self._array("edge_boundaries", edges)
        self.names = [
            library.quadrel_mesh_boundary_name(mesh, k).decode() for k in range(library.quadrel_mesh_boundary_count(mesh))
        ]
        self.diagonal = float(np.hypot(*np.ptp(self.nodes.reshape(-1, 2), axis=0)))

    def __del__(self):
        if hasattr(self, "_mesh"):
            self._library.quadrel_mesh_free(self._mesh)

    def _check(self, status):
        if status != 0:
            raise RuntimeError(self._library.quadrel_last_error_message().decode())

    def _array(self, name, *shape):
        pointer = getattr(self._library, f"quadrel_mesh_{name}")(self._mesh)
        return np.ctypeslib.as_array(pointer, shape=shape).copy()

    def write(self, name, path):
        """Writes the mesh in the format of that name."""
        self._check(self._library.quadrel_mesh_write(self._mesh, FORMATS[name], os.fspath(path).encode()))

    def evaluate(self, places):
        """The elements' points at all pairs of `places` in [-1, 1]: [element][j][i][2]."""
        return tensor(self.reference, self.nodes, places)


def tensor(points, nodes, places):
    """Nodes [element][j][i][2] at pairs of `points`, interpolated to all pairs of `places`."""
    basis = np.array([
        np.prod([(places - x) / (own - x) for x in points if x != own], axis=0) for own in points
    ]).reshape(len(points), len(places))
    return np.einsum("ia,jb,ejic->ebac", basis, basis, nodes)
