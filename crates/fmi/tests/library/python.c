/* A library that takes Python from the program that loads it, as those of PythonFMU do. */
extern int Py_IsInitialized(void);

const char *fmi2GetVersion(void) { return Py_IsInitialized() ? "2.0" : "none"; }
