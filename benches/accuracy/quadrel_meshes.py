"""Meshes of quadrel's, through its C interface."""

import ctypes
import os

import numpy as np

from poisson import Mesh

MAX_NORM = 2


class Library:
    """The shared library with the types of what is used here."""

    def __init__(self, path):
        pointer, number, real = ctypes.c_void_p, ctypes.c_int32, ctypes.c_double
        self._c = c = ctypes.CDLL(os.fspath(path))
        c.quadrel_options_new.restype = pointer
        c.quadrel_last_error_message.restype = ctypes.c_char_p
        c.quadrel_domain_read.argtypes = [ctypes.c_char_p, number, ctypes.POINTER(pointer)]
        c.quadrel_options_set_order.argtypes = [pointer, number]
        c.quadrel_options_set_relative_tolerance.argtypes = [pointer, real, number]
        c.quadrel_options_set_max_element_size.argtypes = [pointer, real]
        c.quadrel_generate.argtypes = [pointer, pointer, pointer, ctypes.POINTER(pointer)]
        for name in ("domain", "options", "mesh"):
            getattr(c, f"quadrel_{name}_free").argtypes = [pointer]
        for name, result in {"element_count": ctypes.c_size_t, "node_count": ctypes.c_size_t,
                             "nodes": ctypes.POINTER(real), "element_nodes": ctypes.POINTER(number)}.items():
            getattr(c, f"quadrel_mesh_{name}").restype = result
            getattr(c, f"quadrel_mesh_{name}").argtypes = [pointer]

    def _check(self, status):
        if status != 0:
            raise RuntimeError(self._c.quadrel_last_error_message().decode())

    def mesh(self, domain, order, tolerance, size=None):
        """A mesh whose boundary is within `tolerance` diagonals, elements at most `size` where that is given."""
        c, own, mesh = self._c, ctypes.c_void_p(), ctypes.c_void_p()
        options = ctypes.c_void_p(c.quadrel_options_new())
        try:
            self._check(c.quadrel_domain_read(os.fspath(domain.path).encode(), -1, ctypes.byref(own)))
            self._check(c.quadrel_options_set_order(options, order))
            self._check(c.quadrel_options_set_relative_tolerance(options, tolerance, MAX_NORM))
            if size is not None:
                self._check(c.quadrel_options_set_max_element_size(options, size))
            self._check(c.quadrel_generate(own, options, None, ctypes.byref(mesh)))
            count, row = c.quadrel_mesh_element_count(mesh), order + 1
            nodes = np.ctypeslib.as_array(c.quadrel_mesh_nodes(mesh), (c.quadrel_mesh_node_count(mesh), 2)).copy()
            numbers = np.ctypeslib.as_array(c.quadrel_mesh_element_nodes(mesh), (count, row, row)).copy()
        finally:
            c.quadrel_mesh_free(mesh)
            c.quadrel_options_free(options)
            c.quadrel_domain_free(own)
        # The library's rows run along the first side.
        numbers = numbers.swapaxes(1, 2)
        return Mesh(nodes[numbers], numbers)
