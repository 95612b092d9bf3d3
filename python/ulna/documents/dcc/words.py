"""What Ulna itself says in a certificate, in English, German and Chinese.

Each entry is (en, de, zh) with the same fields in braces. Texts of the core, such as why something is not determined,
are English in all.
"""

from __future__ import annotations

from ulna.documents.dcc.words_results import RESULTS
from ulna.documents.dcc.words_tests import TESTS

OWN_LANGUAGES = ("en", "de", "zh")

_ADMINISTRATIVE: dict[str, tuple[str, str, str]] = {
    "software": (
        "Calibration of articulated measuring arms, version {version}",
        "Kalibrierung von Gelenkmessarmen, Version {version}",
        "关节臂测量机校准，版本 {version}",
    ),
    "serial": ("Serial number", "Seriennummer", "序列号"),
    "order": ("Order number", "Auftragsnummer", "委托单号"),
    "own-certificate": (
        "Calibration certificate {certificate}",
        "Kalibrierschein {certificate}",
        "校准证书 {certificate}",
    ),
    "certified-by": (
        "Calibration certificate {certificate}, issued by {issuer}",
        "Kalibrierschein {certificate}, ausgestellt von {issuer}",
        "校准证书 {certificate}，由 {issuer} 出具",
    ),
    "draft-name": ("Unsigned draft", "Entwurf ohne Unterschrift", "未签名的草稿"),
    "draft": (
        "This file is an unsigned draft that Ulna wrote. It becomes a certificate when the laboratory has checked it "
        "and signed it.",
        "Diese Datei ist ein Entwurf ohne Unterschrift, den Ulna geschrieben hat. Ein Kalibrierschein wird "
        "daraus, wenn "
        "das Laboratorium sie geprüft und signiert hat.",
        "本文件是由 Ulna 生成的未签名草稿。经实验室核对并签名后方成为校准证书。",
    ),
    "traceability-name": ("Metrological traceability", "Metrologische Rückführung", "计量溯源性"),
    "traceability-missing": (
        "The laboratory has made no statement on metrological traceability.",
        "Das Laboratorium hat zur metrologischen Rückführung nichts angegeben.",
        "实验室未对计量溯源性作出声明。",
    ),
    "accreditation-name": ("Accreditation", "Akkreditierung", "认可"),
    "accreditation": (
        "Accredited by {body}, number {number}.",
        "Akkreditiert durch {body}, Nummer {number}.",
        "由 {body} 认可，编号 {number}。",
    ),
    "accreditation-standard": (
        "Accredited by {body} after {standard}, number {number}.",
        "Akkreditiert durch {body} nach {standard}, Nummer {number}.",
        "由 {body} 依据 {standard} 认可，编号 {number}。",
    ),
    "uncertainty-name": ("Measurement uncertainty", "Messunsicherheit", "测量不确定度"),
    "uncertainty": (
        "U = k u, with k of {distribution} for a coverage probability of {p}, evaluated in the manner of "
        "JCGM 100:2008 "
        "from the covariance of the least-squares fit; the region that holds all fitted parameters together in the "
        "manner of JCGM 102:2011. The noise of the readings was {noise}. What the study does not state, such "
        "as wear, "
        "drift and the operator, is not covered.",
        "U = k u, mit k {distribution} für eine Überdeckungswahrscheinlichkeit von {p}, ermittelt in der Art "
        "von JCGM "
        "100:2008 aus der Kovarianz der Ausgleichung; der Bereich, der alle ausgeglichenen Parameter "
        "gemeinsam enthält, "
        "in der Art von JCGM 102:2011. Das Rauschen der Ablesungen wurde {noise}. Was die Studie nicht nennt, etwa "
        "Verschleiß, Drift und Bediener, ist nicht enthalten.",
        "U = k u，k 取自{distribution}，包含概率为 {p}，按 JCGM 100:2008 的方式由最小二乘拟合的协方差评定；"
        "包含全部拟合参数的区域按 JCGM 102:2011 的方式评定。读数噪声{noise}。研究文件未说明的因素（"
        "如磨损、漂移和操作者）不包括在内。",
    ),
    "normal": ("the normal distribution", "der Normalverteilung", "正态分布"),
    "student": (
        "Student's t with {freedom} degrees of freedom",
        "der t-Verteilung mit {freedom} Freiheitsgraden",
        "自由度为 {freedom} 的 t 分布",
    ),
    "noise-stated": ("stated by the study", "von der Studie angegeben", "由研究文件给出"),
    "noise-estimated": ("estimated from the residuals", "aus den Restabweichungen geschätzt", "由残差估计"),
    "rounding-name": ("Rounding", "Rundung", "修约"),
    "rounding": (
        "Numbers stand here in full, for machines. Where a significantDigit is given it names the power of "
        "ten to which "
        "the value and its U are to be rounded for people: two digits of U.",
        "Zahlen stehen hier ungerundet, für Maschinen. Wo significantDigit angegeben ist, nennt es die "
        "Zehnerpotenz, auf "
        "die der Wert und sein U für Menschen zu runden sind: zwei Stellen von U.",
        "数值以完整精度给出，供机器读取。凡给出 significantDigit 者，其值为供人阅读时数值及其 U 应修约到的 "
        "10 的幂次：U 取两位有效数字。",
    ),
    "held-name": ("Held, not fitted", "Festgehalten, nicht ausgeglichen", "固定而未拟合"),
    "held": (
        "These parameters were held at their values before the calibration and have no uncertainty here: {names}.",
        "Diese Parameter blieben bei ihren Werten vor der Kalibrierung und haben hier keine Unsicherheit: {names}.",
        "下列参数保持校准前的数值，此处不给出不确定度：{names}。",
    ),
    "lost-name": ("Not determined", "Nicht bestimmt", "未能确定"),
    "lost": (
        "The readings do not determine {combination}: {because}. Remedy: {remedy}.",
        "Die Ablesungen bestimmen {combination} nicht: {because}. Abhilfe: {remedy}.",
        "读数不能确定 {combination}：{because}。补救：{remedy}。",
    ),
    "unsure": (
        "The fit has no degrees of freedom: no uncertainty can be given of {names}.",
        "Die Ausgleichung hat keine Freiheitsgrade: Zu {names} lässt sich keine Unsicherheit angeben.",
        "拟合没有自由度：无法给出 {names} 的不确定度。",
    ),
    "prior-name": ("Known beforehand", "Vorher bekannt", "先验已知"),
    "prior": (
        "The readings say next to nothing of these parameters; value and uncertainty are what the study stated "
        "beforehand: {names}.",
        "Die Ablesungen sagen fast nichts über diese Parameter; Wert und Unsicherheit sind, was die Studie vorher "
        "angab: {names}.",
        "读数几乎不含下列参数的信息；其数值和不确定度为研究文件事先给出的先验值：{names}。",
    ),
    "environment": ("Environment", "Umgebung", "环境"),
    "remark": ("Remark", "Bemerkung", "备注"),
}


_ALL = {**_ADMINISTRATIVE, **RESULTS, **TESTS}


def words(key: str, language: str, **values: object) -> str:
    """One of Ulna's own texts in one of `OWN_LANGUAGES`, its fields filled."""
    entry = entries()[key]
    return entry[OWN_LANGUAGES.index(language)].format(**values)


def entries() -> dict[str, tuple[str, str, str]]:
    """All texts."""
    return _ALL
