//! An FMU that misbehaves when it is told to: `attached.c`, and the archive around it.
use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;
use std::process::Command;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

const DESCRIPTION: &str = r#"<?xml version="1.0"?>
<fmiModelDescription fmiVersion="2.0" modelName="attached" guid="{a}" variableNamingConvention="flat">
<CoSimulation modelIdentifier="attached" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUstate="true"/>
<UnitDefinitions>
<Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
<Unit name="m"><BaseUnit m="1"/></Unit>
<Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
<Unit name="kg"><BaseUnit kg="1"/></Unit>
<Unit name="N/m"><BaseUnit kg="1" s="-2"/></Unit>
<Unit name="N s/m"><BaseUnit kg="1" s="-1"/></Unit>
</UnitDefinitions>
<TypeDefinitions><SimpleType name="Mischief"><Enumeration>
<Item name="none" value="1"/><Item name="crash" value="2"/><Item name="hang" value="3"/><Item name="hoard" value="4"/>
<Item name="print" value="5"/><Item name="log" value="6"/><Item name="exit" value="7"/><Item name="not a number" value="8"/>
<Item name="error" value="9"/><Item name="fatal" value="10"/><Item name="discard" value="11"/><Item name="end" value="12"/>
</Enumeration></SimpleType></TypeDefinitions>
<ModelVariables>
<ScalarVariable name="x" valueReference="0" causality="input"><Real start="0" unit="m"/></ScalarVariable>
<ScalarVariable name="v" valueReference="1" causality="input"><Real start="0" unit="m/s"/></ScalarVariable>
<ScalarVariable name="force" valueReference="2" causality="output"><Real unit="N"/></ScalarVariable>
<ScalarVariable name="effort" valueReference="3" causality="input"><Real start="0" unit="N"/></ScalarVariable>
<ScalarVariable name="position" valueReference="4" causality="output"><Real unit="m"/></ScalarVariable>
<ScalarVariable name="velocity" valueReference="5" causality="output"><Real unit="m/s"/></ScalarVariable>
<ScalarVariable name="mass" valueReference="6" causality="parameter" variability="fixed"><Real start="1" unit="kg"/></ScalarVariable>
<ScalarVariable name="stiffness" valueReference="7" causality="parameter" variability="fixed"><Real start="1e4" unit="N/m"/></ScalarVariable>
<ScalarVariable name="damping" valueReference="8" causality="parameter" variability="fixed"><Real start="10" unit="N s/m"/></ScalarVariable>
<ScalarVariable name="mischief" valueReference="0" causality="parameter" variability="fixed"><Enumeration declaredType="Mischief" start="1"/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="3"/><Unknown index="5"/><Unknown index="6"/></Outputs>
<InitialUnknowns><Unknown index="3"/><Unknown index="5"/><Unknown index="6"/></InitialUnknowns></ModelStructure>
</fmiModelDescription>"#;

/// Makes `attached.fmu` in `folder`.
pub(crate) fn make_fmu(folder: &Path) {
    let library = folder.join("attached.so");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/command_line/attached.c");
    let compiled = Command::new("cc").args(["-O2", "-shared", "-fPIC", "-o"]).arg(&library).arg(source).status();
    assert!(compiled.unwrap().success(), "the C compiler that the workspace is built with anyway");
    let mut zip = ZipWriter::new(File::create(folder.join("attached.fmu")).unwrap());
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, content) in [
        ("modelDescription.xml", DESCRIPTION.as_bytes().to_vec()),
        ("binaries/linux64/attached.so", fs::read(&library).unwrap()),
    ] {
        zip.start_file(name, stored).unwrap();
        zip.write_all(&content).unwrap();
    }
    zip.finish().unwrap();
    fs::remove_file(library).unwrap();
}
