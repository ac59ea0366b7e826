"""Domains (.control, .svg) opened in ParaView and VTK as curved meshes: quadrel's reader.

In ParaView: Tools, Manage Plugins, Load New, this file; then File, Open shows .control and .svg files. In VTK:

    reader = quadrel_paraview.QuadrelReader()
    reader.SetFileName("model.control")
    reader.SetOrder(6)
    reader.SetRelativeTolerance(1e-6)
    reader.Update()
    grid = reader.GetOutputDataObject(0)        # vtkUnstructuredGrid of Lagrange quadrilaterals

The grid is that of quadrel's .vtu files: the same points, cells and cell data. Curved cells are drawn curved with a
nonlinear subdivision level of 2 or more (ParaView: Properties, advanced).

The library is looked for in the environment variable QUADREL_LIBRARY (the file's path), beside this file, in
../lib, ../target/release, and where the system looks.

ParaView 5.11 with Python 3.11 or newer (as in Debian 12) loads no Python plugin at all, for it asks Python for
inspect.getargspec, which is gone. Give it back before the plugin is loaded: in View, Python Shell, or in a pvbatch
script, or for good in a file usercustomize.py (see `python3 -m site`):

    import inspect
    inspect.getargspec = inspect.getfullargspec
"""

import ctypes
import ctypes.util
import os

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

try:
    from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy
except ImportError:

    class _Nothing:
        """Decorators that change nothing, where there is no ParaView."""

        def __getattr__(self, name):
            return lambda **description: lambda decorated: decorated

    smdomain = smhint = smproperty = smproxy = _Nothing()

_VTU = 0
_L2 = 0
_TAKE = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t)


def _candidates():
    if os.environ.get("QUADREL_LIBRARY"):
        yield os.environ["QUADREL_LIBRARY"]
        return
    here = os.path.dirname(os.path.abspath(globals().get("__file__", "quadrel_paraview.py")))
    for folder in (".", "../lib", "../target/release"):
        for name in ("libquadrel.so", "libquadrel.dylib", "quadrel.dll"):
            path = os.path.normpath(os.path.join(here, folder, name))
            if os.path.exists(path):
                yield path
    found = ctypes.util.find_library("quadrel")
    if found:
        yield found


def _load():
    """The library with the types of the functions used here."""
    for path in _candidates():
        library = ctypes.CDLL(path)
        pointer, text, number = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int32
        types = {
            "quadrel_domain_read": (number, [text, number, ctypes.POINTER(pointer)]),
            "quadrel_domain_file_order": (ctypes.c_int, [pointer]),
            "quadrel_domain_file_tolerance": (ctypes.c_double, [pointer]),
            "quadrel_domain_free": (None, [pointer]),
            "quadrel_options_new": (pointer, []),
            "quadrel_options_set_order": (number, [pointer, ctypes.c_int]),
            "quadrel_options_set_tolerance": (number, [pointer, ctypes.c_double, number]),
            "quadrel_options_set_relative_tolerance": (number, [pointer, ctypes.c_double, number]),
            "quadrel_options_free": (None, [pointer]),
            "quadrel_generate": (number, [pointer, pointer, pointer, ctypes.POINTER(pointer)]),
            "quadrel_mesh_write_to": (number, [pointer, number, _TAKE, pointer]),
            "quadrel_mesh_free": (None, [pointer]),
            "quadrel_last_error_message": (text, []),
        }
        for name, (result, arguments) in types.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
        return library
    raise RuntimeError("quadrel's library is not found; set QUADREL_LIBRARY to the path of libquadrel.so")


def vtu(path, order=0, relative_tolerance=0.0, component=-1):
    """The text of the .vtu file of a domain's mesh. Order and tolerance 0: the file's, else 5 and 1e-5 of the diagonal;
    `component` chooses one of several, -1 takes the only one. RuntimeError says why there is no mesh."""
    library = _load()

    def check(status):
        if status != 0:
            raise RuntimeError(library.quadrel_last_error_message().decode())

    domain, mesh = ctypes.c_void_p(), ctypes.c_void_p()
    options = ctypes.c_void_p(library.quadrel_options_new())
    pieces = []

    def take(_, data, count):
        pieces.append(ctypes.string_at(data, count))
        return 0

    try:
        check(library.quadrel_domain_read(os.fspath(path).encode(), component, ctypes.byref(domain)))
        wanted = order or library.quadrel_domain_file_order(domain)
        if wanted > 0:
            check(library.quadrel_options_set_order(options, wanted))
        tolerance = library.quadrel_domain_file_tolerance(domain)
        if relative_tolerance:
            check(library.quadrel_options_set_relative_tolerance(options, relative_tolerance, _L2))
        elif tolerance > 0:
            check(library.quadrel_options_set_tolerance(options, tolerance, _L2))
        check(library.quadrel_generate(domain, options, None, ctypes.byref(mesh)))
        check(library.quadrel_mesh_write_to(mesh, _VTU, _TAKE(take), None))
    finally:
        library.quadrel_mesh_free(mesh)
        library.quadrel_options_free(options)
        library.quadrel_domain_free(domain)
    return b"".join(pieces).decode()


@smproxy.reader(
    name="QuadrelReader", label="quadrel", extensions="control svg", file_description="Domains meshed by quadrel"
)
class QuadrelReader(VTKPythonAlgorithmBase):
    """Meshes a domain when it is read, and again when a property changes."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkUnstructuredGrid")
        self._path, self._order, self._tolerance, self._component = None, 0, 0.0, -1

    def _set(self, name, value):
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()

    @smproperty.stringvector(name="FileName", panel_visibility="never")
    @smdomain.filelist()
    @smhint.filechooser(extensions="control svg", file_description="Domains meshed by quadrel")
    def SetFileName(self, path):
        """A HOHQMesh control file or an SVG path."""
        self._set("_path", path)

    @smproperty.intvector(name="Order", default_values=0)
    @smdomain.intrange(min=0, max=32)
    def SetOrder(self, order):
        """Polynomial order of the elements, 1 to 32; 0: the file's, else 5."""
        self._set("_order", order)

    @smproperty.doublevector(name="RelativeTolerance", default_values=0.0)
    def SetRelativeTolerance(self, tolerance):
        """Largest boundary error for a domain of diagonal 1; 0: the file's, else 1e-5."""
        self._set("_tolerance", tolerance)

    @smproperty.intvector(name="Component", default_values=-1)
    def SetComponent(self, component):
        """Which part of a file with several, from 0 by descending area; -1: there is one."""
        self._set("_component", component)

    def RequestData(self, request, inputs, outputs):
        """Called by VTK when the mesh is wanted."""
        output = vtkUnstructuredGrid.GetData(outputs, 0)
        if not self._path or self._path == "None":
            return 1
        try:
            text = vtu(self._path, self._order, self._tolerance, self._component)
        except (RuntimeError, OSError) as error:
            vtkOutputWindow.GetInstance().DisplayErrorText(f"quadrel: {self._path}: {error}\n")
            return 0
        reader = vtkXMLUnstructuredGridReader()
        reader.ReadFromInputStringOn()
        reader.SetInputString(text)
        reader.Update()
        output.ShallowCopy(reader.GetOutput())
        return 1
