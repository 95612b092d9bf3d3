"""Ulna: calibration of articulated measuring arms.

    import ulna
    study = ulna.Study.load("study.toml")
    result = ulna.calibrate(study)
    result.save("out")

Names are loaded when they are first used, so that `import ulna` and `ulna --help` stay quick: `__init__.pyi` says where
each is.
"""

import lazy_loader

from ulna.ground import renamed
from ulna.ground.version import VERSION

__getattr__, _, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = [*_names, "__version__"]
__version__ = VERSION
renamed.install()


def __dir__() -> list[str]:
    return __all__
