"""Ulna: calibration of articulated measuring arms.

    import ulna
    study = ulna.Study.load("study.toml")
    result = ulna.calibrate(study)
    result.save("out")

Names are loaded when they are first used, so that `import ulna` and `ulna --help` stay quick: `__init__.pyi` says where
each is.
"""

import lazy_loader

from ulna.ground import provided, renamed
from ulna.ground.version import VERSION

__getattr__, _, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = [*_names, "__version__"]
__version__ = VERSION
renamed.install()
provided.provide(
    {
        "arm of a URDF": "ulna.exchange.in_memory:arm_of_urdf",
        "arm of a DH table": "ulna.exchange.in_memory:arm_of_dh",
        "columns of a frame": "ulna.proposals.recognised:recognised",
        "artefact of a record": "ulna.records.lending:lent",
        "plots of a result": "ulna.documents.plotted:ResultPlots",
    }
)


def __dir__() -> list[str]:
    return __all__
